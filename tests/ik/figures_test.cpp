// The figures that `skitter ik` reports of many solves.
#include "app/ik/figures.h"

#include <gtest/gtest.h>

namespace skitter::test {
namespace {

TEST(IkFigures, TheNinetyNinthPercentileIsReachedByNinetyNineInAHundred) {
  const ik::Chain chain{.bones = std::vector<ik::Bone>(2, {.length = 1}), .pole = {}};
  for (const auto& [slow, expected] : {std::pair{2u, 3u}, {3u, 40u}, {200u, 40u}}) {
    app::IkFigures figures(chain);
    const std::vector<glm::vec3> targets(200, {0, 2, 0});
    app::IkLot lot;
    for (uint32_t solve = 0; solve < targets.size(); ++solve) {
      lot.joints.insert(lot.joints.end(), {{0, 0, 0}, {0, 1, 0}, {0, 2, 0}});
      lot.reports.push_back({.iterations = solve < slow ? 40u : 3u});
    }
    figures.add(targets, lot);
    EXPECT_EQ(figures.p99Iterations(), expected) << slow;
    EXPECT_EQ(figures.solves(), 200u);
    EXPECT_EQ(figures.solvedFraction(), 1);
    EXPECT_NEAR(figures.meanIterations(), (3.0 * (200 - slow) + 40.0 * slow) / 200, 1e-12);
  }
}

}  // namespace
}  // namespace skitter::test

#include <gtest/gtest.h>

#include <limits>

#include "cpu_reference/ik/tree.h"

namespace skitter::test {
namespace {

using namespace reference;

// Four legs of three bones about a body; the feet at rest a little below.
class IkTrees : public testing::Test {
 protected:
  IkTrees()
      : tree(IkTree::of(std::vector(4, std::vector{0.4, 0.5, 0.3}),
                        {{0.3, 0, 0.3}, {0.3, 0, -0.3}, {-0.3, 0, 0.3}, {-0.3, 0, -0.3}})) {
    for (const IkTree::Leg& leg : tree.legs) {
      const glm::dvec3 out = glm::normalize(leg.offset);
      Joints joints{leg.offset, leg.offset + 0.4 * out};
      joints.push_back(joints.back() + 0.5 * glm::normalize(out - glm::dvec3(0, 1, 0)));
      joints.push_back(joints.back() + glm::dvec3(0, -0.3, 0));
      rest.legs.push_back(joints);
      feet.push_back(joints.back());
    }
  }

  void expectWhole(const IkTreeState& state) const {
    for (size_t b = 0; b < tree.legs.size(); ++b) {
      EXPECT_NEAR(glm::length(state.legs[b][0] - state.body - tree.legs[b].offset), 0, 1e-12);
      for (size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(glm::length(state.legs[b][i + 1] - state.legs[b][i]), tree.legs[b].bones[i].length,
                    1e-12);
      }
    }
  }

  IkTree tree;
  IkTreeState rest;
  std::vector<glm::dvec3> feet;
};

TEST_F(IkTrees, floatingBodyFollowsItsFeet) {
  const glm::dvec3 shift{2, 0.5, -1};
  for (glm::dvec3& foot : feet) foot += shift;
  const IkTreeResult result = solveTree(tree, feet, rest, 9e-4, 100);
  EXPECT_EQ(result.stop, IkStop::tolerance);
  EXPECT_LE(result.error, 9e-4);
  EXPECT_GT(glm::dot(result.state.body, shift) / glm::dot(shift, shift), 0.5);
  expectWhole(result.state);
}

TEST_F(IkTrees, anchoredBodyStays) {
  tree.anchor = {0.05, 0.1, 0};
  tree.anchorShare = 1;
  for (glm::dvec3& foot : feet) foot.x += 0.1;
  const IkTreeResult result = solveTree(tree, feet, rest, 9e-4, 100);
  EXPECT_EQ(result.stop, IkStop::tolerance);
  EXPECT_EQ(result.state.body, tree.anchor);
  expectWhole(result.state);
}

TEST_F(IkTrees, halfAnchoredBodyIsBetween) {
  for (glm::dvec3& foot : feet) foot += glm::dvec3(1, 0, 0);
  IkTreeState floating = rest, half = rest;
  iterateTree(tree, feet, floating);
  tree.anchorShare = 0.5;
  iterateTree(tree, feet, half);
  EXPECT_NEAR(glm::length(half.body - 0.5 * floating.body), 0, 1e-12);
  EXPECT_GT(floating.body.x, 0.1);
}

TEST_F(IkTrees, feetThatPullApartStall) {
  for (glm::dvec3& foot : feet) foot *= 3;
  const IkTreeResult result = solveTree(tree, feet, rest, 9e-4, 1000);
  EXPECT_EQ(result.stop, IkStop::stall);
  EXPECT_GT(result.error, 0.5);
  expectWhole(result.state);
}

TEST_F(IkTrees, keepsWhatItHas) {
  const IkTreeResult kept = solveTree(tree, feet, rest, 9e-4, 10);
  EXPECT_EQ(kept.iterations, 0);
  EXPECT_EQ(kept.stop, IkStop::tolerance);
  feet[2].y = std::numeric_limits<double>::quiet_NaN();
  const IkTreeResult skipped = solveTree(tree, feet, rest, 9e-4, 10);
  EXPECT_EQ(skipped.stop, IkStop::skipped);
  EXPECT_EQ(skipped.state.legs, rest.legs);
}

TEST_F(IkTrees, errorIsTheLargestLegsOverTheLongest) {
  feet[1].x += 0.6;
  feet[3].x += 0.3;
  EXPECT_NEAR(treeError(tree, feet, rest), 0.5, 1e-12);
}

TEST_F(IkTrees, refusesWhatIsNoTree) {
  EXPECT_THROW(IkTree::of({}, {}), std::invalid_argument);
  EXPECT_THROW(IkTree::of({{1}}, {}), std::invalid_argument);
  EXPECT_THROW(IkTree::of({{}}, {{0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(IkTree::of({{1, -1}}, {{0, 0, 0}}), std::invalid_argument);
}

}  // namespace
}  // namespace skitter::test

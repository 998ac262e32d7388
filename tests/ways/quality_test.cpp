// How near a colony comes to the shortest way, which Dijkstra's algorithm knows.
#include <fmt/format.h>

#include <algorithm>

#include "support/gpu_fixture.h"
#include "ways/maps.h"

namespace skitter::test {
namespace {

using ColonyQualityTest = GpuTest;

// The bounds are those that docs/colony.md promises of 100 seeds: these are some of them.
TEST_F(ColonyQualityTest, WaysThroughThreatsAreNearlyTheShortest) {
  std::vector<double> ratios;
  for (const uint64_t map : {1u, 2u, 3u})
    for (uint64_t seed = 1; seed <= 3; ++seed) {
      ColonyCase each = threatCase(128, map);
      each.options.seed = seed;
      Colony colony(device(), each.grid, each.nest, each.goal, each.options);
      colony.search(100);
      const std::optional<ColonyPath> best = colony.best();
      ASSERT_TRUE(best) << each.name;
      const double ratio = best->fixedLength / static_cast<double>(referenceOf(each).shortest());
      fmt::print("{}, seed {}: {:.4f}, found in {}\n", each.name, seed, ratio, best->iteration);
      EXPECT_GE(ratio, 1) << each.name;
      EXPECT_LE(ratio, 1.1) << each.name << ", seed " << seed;
      ratios.push_back(ratio);
    }
  std::nth_element(ratios.begin(), ratios.begin() + 4, ratios.end());
  EXPECT_LE(ratios[4], 1.03);
}

}  // namespace
}  // namespace skitter::test

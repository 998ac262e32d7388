#include "experiments/agents.h"

#include <gtest/gtest.h>

namespace skitter::experiments {
namespace {

TEST(Roughness, IsWhatAPlaneDoesNotExplain) {
  const Rig rig = spiderRig();
  Heightfield slope{"slope", 3, 3, 4, 4, {0, 1, 2, 3, 4, 5, 6, 7, 8}};
  EXPECT_NEAR(roughnessAt(slope, rig, {0, 0, 0}, {0.6, 0.8}), 0, 1e-6);
  Heightfield edge{"roof", 3, 2, 4, 4, {-1, 0, -1, -1, 0, -1}};
  EXPECT_GT(roughnessAt(edge, rig, {0, 0, 0}, {0, 1}), 0.01);
}

}  // namespace
}  // namespace skitter::experiments

#include "crowd/burden.h"

#include <gtest/gtest.h>

namespace skitter::crowd {
namespace {

Regait gait() {
  return {.groups = 2,
          .shift = {0.01f, 0.02f, 0.03f},
          .speed = 0.8f,
          .legs = {{.slowness = 1}, {.slowness = lameSlowness}}};
}

TEST(Burden, NoneLeavesTheGait) {
  const Regait same = burdened(gait(), {.share = 0, .offset = {1, 1, 1}}, 0.5f, 0.3f);
  EXPECT_EQ(same.shift, gait().shift);
  EXPECT_EQ(same.speed, 0.8f);
  EXPECT_EQ(same.legs[1].slowness, lameSlowness);
}

// All values below are exact but for the roundings of a handful of float operations: EXPECT_FLOAT_EQ's 4 ulp.
TEST(Burden, OwnMassHalvesSpeedAndOffset) {
  const Burden burden{.share = 1, .offset = {0, 0.1f, -0.2f}};
  EXPECT_FLOAT_EQ(combinedCentre(burden).z, -0.1f);
  const Regait slow = burdened(gait(), burden, 0.5f, 0.3f);
  EXPECT_FLOAT_EQ(slow.speed, 0.4f);
  EXPECT_FLOAT_EQ(slow.shift.x, 0.01f);
  EXPECT_FLOAT_EQ(slow.shift.y, 0.02f + 0.2f * 0.5f * 0.3f);
  EXPECT_FLOAT_EQ(slow.shift.z, 0.03f - 0.1f * 0.5f);
  EXPECT_FLOAT_EQ(slow.legs[1].slowness, 0.6f * lameSlowness);
}

TEST(Burden, LeanHasALimit) {
  const Regait far = burdened(gait(), {.share = 4, .offset = {2, 0, 0}}, 0.5f, 0.3f);
  EXPECT_FLOAT_EQ(far.shift.x, 0.01f + 0.3f * 0.5f);
}

}  // namespace
}  // namespace skitter::crowd

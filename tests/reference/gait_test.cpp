#include "cpu_reference/gait.h"

#include <gtest/gtest.h>

#include "reference_herd.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

class Gait : public testing::Test {
 protected:
  // Moves the foot of leg l away from home along x by `share` of the reach.
  void displace(size_t l, double x) {
    steps[l] = plantedAt(body, creature.limbs[l].home + glm::dvec3(x, 0, 0));
  }
  uint32_t maskOf(int group) const {
    uint32_t mask = 0;
    for (size_t l = 0; l < creature.limbs.size(); ++l) {
      if (creature.limbs[l].group == group) mask |= 1u << l;
    }
    return mask;
  }

  reference::Tuning tuning = validation::tuningOf(parametersFor(flatField()));
  reference::Creature creature = spiderCreature();
  reference::AgentBody body = bodyAt(1, 1);
  std::vector<reference::Step> steps = stepsAtHome(creature, body);
  std::vector<double> errors = std::vector<double>(8);
};

TEST_F(Gait, feetAtHomeStay) {
  body.v3 = body.speed = 1;
  for (double phase = 0; phase < 1; phase += 0.05) {
    EXPECT_EQ(reference::gait(tuning, creature, body, phase, steps, errors, 10).gait.lift, 0u);
  }
}

TEST_F(Gait, displacedFeetLiftGroupByGroup) {
  for (size_t l = 0; l < 8; ++l) displace(l, 0.1);
  EXPECT_EQ(reference::gait(tuning, creature, body, 0.05, steps, errors, 10).gait.lift, maskOf(0));
  EXPECT_EQ(reference::gait(tuning, creature, body, 0.55, steps, errors, 10).gait.lift, maskOf(1));
  EXPECT_EQ(reference::gait(tuning, creature, body, 0.30, steps, errors, 10).gait.lift, 0u);
}

TEST_F(Gait, nobodyLiftsWhileTheOtherGroupFlies) {
  for (size_t l = 0; l < 8; ++l) displace(l, 0.1);
  for (size_t l = 0; l < 8; ++l) {
    if (creature.limbs[l].group != 1) continue;
    steps[l].firstTick = 5;
    steps[l].duration = 20;
    EXPECT_EQ(reference::gait(tuning, creature, body, 0.05, steps, errors, 10).gait.lift, 0u);
    break;
  }
}

TEST_F(Gait, nobodyLiftsWhenSettled) {
  for (size_t l = 0; l < 8; ++l) displace(l, 0.1);
  body.still = 2;
  EXPECT_EQ(reference::gait(tuning, creature, body, 0.05, steps, errors, 10).gait.lift, 0u);
}

TEST_F(Gait, legThatMustLiftMovesThePhase) {
  size_t other = 0;
  while (creature.limbs[other].group != 1) ++other;
  steps[other] = plantedAt(body, creature.limbs[other].root + glm::dvec3(0.97, 0, 0));
  const auto result = reference::gait(tuning, creature, body, 0.05, steps, errors, 10);
  EXPECT_TRUE(result.emergency);
  EXPECT_DOUBLE_EQ(result.gait.phase, 0.5);
  EXPECT_EQ(result.gait.lift, 1u << other);
}

TEST_F(Gait, footTooNearItsRootGoesBeforeAStretchedOne) {
  size_t other = 0;
  while (creature.limbs[other].group != 1) ++other;
  steps[0] = plantedAt(body, creature.limbs[0].root + glm::dvec3(0.97, 0, 0));
  steps[other] = plantedAt(body, creature.limbs[other].root + glm::dvec3(0.1, 0, 0));
  EXPECT_DOUBLE_EQ(reference::gait(tuning, creature, body, 0.3, steps, errors, 10).gait.phase, 0.5);
}

TEST_F(Gait, footThatStraysOrMissesMustLift) {
  displace(0, 1.01 * tuning.strayShare * tuning.halfStrideStill);
  EXPECT_TRUE(reference::gait(tuning, creature, body, 0.3, steps, errors, 10).legs[0].must);
  displace(0, 0);
  EXPECT_FALSE(reference::gait(tuning, creature, body, 0.3, steps, errors, 10).legs[0].must);
  errors[0] = 1.01 * tuning.errorLift;
  const auto result = reference::gait(tuning, creature, body, 0.3, steps, errors, 10);
  EXPECT_TRUE(result.legs[0].must);
  EXPECT_EQ(result.gait.lift, 1u);
}

TEST_F(Gait, landingThatTheBodyLeftBehindIsAimedAnew) {
  steps[0].firstTick = 5;
  steps[0].duration = 20;
  body.v3 = body.speed = 2;
  EXPECT_EQ(reference::gait(tuning, creature, body, 0, steps, errors, 12).gait.reaim, 1u);
  EXPECT_EQ(reference::gait(tuning, creature, body, 0, steps, errors, 9).gait.reaim, 0u);
  EXPECT_EQ(reference::gait(tuning, creature, body, 0, steps, errors, 24).gait.reaim, 0u);
}

TEST_F(Gait, fasterMeansShorterAndWider) {
  const auto slow = reference::gait(tuning, creature, body, 0, steps, errors, 1).gait;
  body.v3 = 1.5;
  const auto fast = reference::gait(tuning, creature, body, 0, steps, errors, 1).gait;
  EXPECT_LT(fast.duration, slow.duration);
  EXPECT_LT(fast.cycle, slow.cycle);
  EXPECT_GT(fast.halfStride, slow.halfStride);
}

TEST_F(Gait, marginsTellHowNearADecisionWas) {
  const double enough = tuning.liftShare * (tuning.halfStrideStill);
  displace(0, enough + 1e-3);
  const auto result = reference::gait(tuning, creature, body, 0.05, steps, errors, 10);
  EXPECT_TRUE(result.legs[0].wants);
  EXPECT_NEAR(result.legs[0].wantsMargin, 1e-3, 1e-9);
  EXPECT_NEAR(result.legs[1].wantsMargin, enough, 1e-9);
}

TEST(GaitHerd, twoGroupsAreNeverInTheAirTogether) {
  ReferenceHerd herd(roughField(), 16);
  const reference::Creature creature = spiderCreature();
  int flights = 0;
  for (int tick = 0; tick < 600; ++tick) {
    herd.tick();
    for (size_t agent = 0; agent < 16; ++agent) {
      bool inAir[2] = {};
      for (size_t l = 0; l < 8; ++l) {
        if (validation::footOf(herd.state(), agent * 8 + l).progress < 1) {
          inAir[creature.limbs[l].group] = true;
          ++flights;
        }
      }
      ASSERT_FALSE(inAir[0] && inAir[1]) << "tick " << tick << ", agent " << agent;
    }
  }
  EXPECT_GT(flights, 10000);
}

}  // namespace
}  // namespace skitter::test

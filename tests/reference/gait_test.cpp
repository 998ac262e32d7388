#include "cpu_reference/stages/gait.h"

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

  reference::Tuning tuning = validation::tuningOf(parametersFor(flatField()));
  reference::Creature creature = spiderCreature();
  reference::AgentBody body = bodyAt(1, 1);
  std::vector<reference::Step> steps = stepsAtHome(creature, body);
  std::vector<double> misses = std::vector<double>(8);
};

TEST_F(Gait, feetAtHomeStay) {
  body.surfaceSpeed = body.speed = 1;
  for (double phase = 0; phase < 1; phase += 0.05) {
    EXPECT_EQ(reference::gait(tuning, creature, body, phase, steps, misses, 10).gait.lift, 0u);
  }
}

TEST_F(Gait, displacedFeetLiftInTheirWindows) {
  for (size_t l = 0; l < 8; ++l) displace(l, 0.1);
  // At rest 1/2 - T/C is 0.21 and the spread 1.2 times it, 0.25: as long as a window is open. In the middle
  // of the first quarter the rear half of a group is within its window and the front half not yet.
  const auto lifts = [&](double phase) {
    return reference::gait(tuning, creature, body, phase, steps, misses, 10).gait.lift;
  };
  EXPECT_EQ(lifts(0.02), 1u << 7);
  EXPECT_EQ(lifts(0.12), 1u << 7 | 1u << 2);
  EXPECT_EQ(lifts(0.20), 1u << 7 | 1u << 2 | 1u << 5);
  EXPECT_EQ(lifts(0.52), 1u << 3);
  EXPECT_EQ(lifts(0.70), 1u << 3 | 1u << 6 | 1u << 1);
}

TEST_F(Gait, legsOfASideLiftInTheOrder4231) {
  body.surfaceSpeed = body.speed = 1;
  for (size_t l = 0; l < 8; ++l) displace(l, 0.15);
  std::vector<size_t> order;
  uint32_t before = 0;
  for (double phase = 0.47; phase < 1.47; phase += 0.005) {
    const auto result = reference::gait(tuning, creature, body, std::fmod(phase, 1), steps, misses, 10);
    uint32_t open = 0;
    for (size_t l = 0; l < 4; ++l) open |= result.legs[l].open ? 1u << l : 0u;
    for (size_t l = 0; l < 4; ++l) {
      if ((open & ~before) >> l & 1u) order.push_back(l + 1);
    }
    before = open;
  }
  EXPECT_EQ(order, (std::vector<size_t>{4, 2, 3, 1}));
}

TEST_F(Gait, nobodyLiftsBesideALegInTheAir) {
  for (size_t l = 0; l < 8; ++l) displace(l, 0.1);
  steps[1].firstTick = 5;
  steps[1].duration = 20;
  for (double phase = 0; phase < 1; phase += 0.01) {
    const uint32_t lift = reference::gait(tuning, creature, body, phase, steps, misses, 10).gait.lift;
    EXPECT_EQ(lift & (1u << 0 | 1u << 1 | 1u << 2), 0u) << phase;
  }
}

TEST_F(Gait, nobodyLiftsWhenSettled) {
  for (size_t l = 0; l < 8; ++l) displace(l, 0.1);
  body.still = 2;
  EXPECT_EQ(reference::gait(tuning, creature, body, 0.05, steps, misses, 10).gait.lift, 0u);
}

TEST_F(Gait, legThatMustLiftDoesSoOutsideItsWindow) {
  steps[3] = plantedAt(body, creature.limbs[3].root + glm::dvec3(0.97, 0, 0));
  const auto result = reference::gait(tuning, creature, body, 0.05, steps, misses, 10);
  EXPECT_EQ(result.first, 3);
  EXPECT_EQ(result.gait.lift, 1u << 3);
}

TEST_F(Gait, neighboursWaitForALegThatMustLift) {
  for (size_t l = 0; l < 8; ++l) displace(l, 0.1);
  steps[3] = plantedAt(body, creature.limbs[3].root + glm::dvec3(0.97, 0, 0));
  steps[2].firstTick = 5;
  steps[2].duration = 20;
  // Leg 2 is in the air, so leg 3 waits; its other neighbour 7 is within its window and waits for it.
  EXPECT_EQ(reference::gait(tuning, creature, body, 0.02, steps, misses, 10).gait.lift, 0u);
}

TEST_F(Gait, ofLegsThatMustLiftTheOneThatStoodLongestGoesFirst) {
  for (const size_t l : {0u, 1u}) steps[l] = plantedAt(body, creature.limbs[l].root + glm::dvec3(0.97, 0, 0));
  steps[0].firstTick = -5;
  const auto result = reference::gait(tuning, creature, body, 0.3, steps, misses, 10);
  EXPECT_EQ(result.first, 0);
  EXPECT_EQ(result.gait.lift, 1u);
  steps[1].firstTick = -6;
  EXPECT_EQ(reference::gait(tuning, creature, body, 0.3, steps, misses, 10).gait.lift, 2u);
}

TEST_F(Gait, footThatStraysOrMissesMustLift) {
  displace(0, 1.01 * tuning.strayShare * tuning.halfStrideStill);
  EXPECT_TRUE(reference::gait(tuning, creature, body, 0.3, steps, misses, 10).legs[0].must);
  displace(0, 0);
  EXPECT_FALSE(reference::gait(tuning, creature, body, 0.3, steps, misses, 10).legs[0].must);
  misses[0] = 1.01 * tuning.errorLift;
  const auto result = reference::gait(tuning, creature, body, 0.3, steps, misses, 10);
  EXPECT_TRUE(result.legs[0].must);
  EXPECT_EQ(result.gait.lift, 1u);
}

TEST_F(Gait, landingThatTheBodyLeftBehindIsAimedAnew) {
  steps[0].firstTick = 5;
  steps[0].duration = 20;
  body.surfaceSpeed = body.speed = 2;
  EXPECT_EQ(reference::gait(tuning, creature, body, 0, steps, misses, 12).gait.reaim, 1u);
  EXPECT_EQ(reference::gait(tuning, creature, body, 0, steps, misses, 9).gait.reaim, 0u);
  EXPECT_EQ(reference::gait(tuning, creature, body, 0, steps, misses, 24).gait.reaim, 0u);
}

TEST_F(Gait, dutyFallsLinearlyWithSpeed) {
  double before = 2;
  for (const double speed : {0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0}) {
    body.surfaceSpeed = speed;
    const auto gait = reference::gait(tuning, creature, body, 0, steps, misses, 1).gait;
    EXPECT_NEAR(1 - gait.duration * tuning.dt / gait.cycle, 0.75 - 0.05 * speed, 1e-6);
    EXPECT_LT(gait.cycle, before);
    before = gait.cycle;
  }
}

TEST_F(Gait, marginsTellHowNearADecisionWas) {
  const double enough = tuning.liftShare * (tuning.halfStrideStill);
  displace(0, enough + 1e-3);
  const auto result = reference::gait(tuning, creature, body, 0.05, steps, misses, 10);
  EXPECT_TRUE(result.legs[0].wants);
  EXPECT_NEAR(result.legs[0].wantsMargin, 1e-3, 1e-9);
  EXPECT_NEAR(result.legs[1].wantsMargin, enough, 1e-9);
}

TEST(GaitHerd, neighboursAreNeverInTheAirTogether) {
  ReferenceHerd herd(roughField(), 16);
  const reference::Creature creature = spiderCreature();
  int flights = 0;
  for (int tick = 0; tick < 600; ++tick) {
    herd.tick();
    for (size_t agent = 0; agent < 16; ++agent) {
      uint32_t air = 0;
      for (size_t l = 0; l < 8; ++l)
        if (validation::footOf(herd.state(), agent * 8 + l).progress < 1) air |= 1u << l;
      for (size_t l = 0; l < 8; ++l) {
        if ((air >> l & 1u) == 0) continue;
        ASSERT_EQ(air & creature.limbs[l].neighbours, 0u) << "tick " << tick << ", agent " << agent;
        ++flights;
      }
    }
  }
  EXPECT_GT(flights, 10000);
}

}  // namespace
}  // namespace skitter::test

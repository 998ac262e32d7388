// The loop controller: a body that lies on the ground below its homes, and feet that run round their loops.
#include <gtest/gtest.h>

#include "cpu_reference/stages/body.h"
#include "cpu_reference/stages/gait_loop.h"
#include "cpu_reference/stages/swing_loop.h"
#include "spider.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

class Loop : public testing::Test {
 protected:
  Loop() { body.surfaceSpeed = body.speed = 1; }
  reference::Gait gaitAt(double phase) const {
    reference::Gait gait = reference::loopGait(tuning, 2, body, phase).gait;
    gait.phase = phase;
    return gait;
  }
  // Leg 0, whose group is the first: its theta is the phase.
  reference::LoopFoot footAt(double phase, size_t leg = 0) const {
    return reference::loopSwing(tuning, 2, creature.limbs[leg], body, gaitAt(phase));
  }
  double stanceShare() const {
    const reference::Gait gait = gaitAt(0);
    return 1 - gait.duration * tuning.dt / gait.cycle;
  }

  Heightfield terrain = flatField();
  reference::Tuning tuning = validation::tuningOf(parametersFor(terrain));
  reference::Heights heights = validation::heightsOf(terrain, parametersFor(terrain));
  reference::Creature creature = spiderCreature();
  reference::AgentBody body = bodyAt(0.5, 0.5);
};

TEST_F(Loop, stanceIsStraightUniformAndAsFastAsTheBody) {
  const double cycle = gaitAt(0).cycle, step = 1e-2;
  const glm::dvec3 home = creature.limbs[0].home;
  for (double phase = step; phase < stanceShare(); phase += step) {
    const reference::LoopFoot before = footAt(phase - step), now = footAt(phase);
    EXPECT_EQ(now.foot.progress, 1);
    EXPECT_NEAR(now.foot.target.z - before.foot.target.z, -body.surfaceSpeed * step * cycle, 1e-12);
    EXPECT_NEAR(now.foot.target.x, home.x, 1e-12);
    EXPECT_NEAR(now.foot.target.y, home.y, 1e-12);
  }
}

TEST_F(Loop, homeIsInTheMiddleOfTheStance) {
  EXPECT_NEAR(glm::length(footAt(stanceShare() / 2).foot.target - creature.limbs[0].home), 0, 1e-12);
}

TEST_F(Loop, isClosedWhereFeetLiftAndLand) {
  body.turnRate = 0.7;
  const double lifts = stanceShare(), tiny = 1e-9;
  EXPECT_EQ(footAt(lifts - tiny).foot.progress, 1);
  EXPECT_LT(footAt(lifts + tiny).foot.progress, 1e-6);
  EXPECT_NEAR(glm::length(footAt(lifts - tiny).foot.target - footAt(lifts + tiny).foot.target), 0, 1e-7);
  EXPECT_EQ(footAt(1 - tiny).foot.progress, 0.999);
  EXPECT_NEAR(glm::length(footAt(1 - tiny).foot.target - footAt(0).foot.target), 0, 1e-7);
}

TEST_F(Loop, swingRisesByTheStepHeightAndLessWhenSlow) {
  const double middle = 1 - (1 - stanceShare()) / 2;
  EXPECT_NEAR(footAt(middle).foot.target.y, tuning.stepHeight, 1e-9);
  EXPECT_NEAR(footAt(middle).foot.target.z, creature.limbs[0].home.z, 1e-9);
  body.surfaceSpeed = body.speed = 0.02;
  EXPECT_NEAR(footAt(1 - (1 - stanceShare()) / 2).foot.target.y, 0.2 * tuning.stepHeight, 1e-9);
}

TEST_F(Loop, groupsAreAShareOfTheCycleApart) {
  size_t other = 0;
  while (creature.limbs[other].group != 1) ++other;
  EXPECT_NEAR(footAt(0.3, other).theta, 0.8, 1e-12);
  EXPECT_NEAR(footAt(0.7, other).theta, 0.2, 1e-12);
}

TEST_F(Loop, everythingTurnsWithTheBody) {
  const glm::dvec3 before = footAt(0.2).foot.target;
  body.orientation = glm::normalize(glm::dquat(0.9, 0.2, -0.1, 0.3));
  EXPECT_NEAR(glm::length(footAt(0.2).foot.target - body.orientation * before), 0, 1e-12);
}

TEST_F(Loop, phaseRunsWithTheCycleAndStaysWhileStill) {
  const reference::Gait moving = reference::loopGait(tuning, 2, body, 0.99).gait;
  EXPECT_NEAR(moving.phase, std::fmod(0.99 + tuning.dt / moving.cycle, 1), 1e-12);
  EXPECT_EQ(moving.lift | moving.reaim | moving.air, 0u);
  body.still = tuning.dt;
  EXPECT_EQ(reference::loopGait(tuning, 2, body, 0.99).gait.phase, 0.99);
}

// The goal of it all: walking straight at a constant speed a foot in stance stays where it is in the world.
TEST_F(Loop, feetDoNotSlipOnAStraightWay) {
  double phase = 0;
  std::vector<reference::Foot> last(8);
  double worst = 0;
  for (int n = 0; n < 300; ++n) {
    const double before = body.world().y;
    body = reference::blindBody(tuning, heights, creature, body, glm::dvec2(0, 1)).body;
    const reference::Gait gait = reference::loopGait(tuning, 2, body, phase).gait;
    phase = gait.phase;
    for (size_t l = 0; l < 8; ++l) {
      const reference::Foot foot = reference::loopSwing(tuning, 2, creature.limbs[l], body, gait).foot;
      const bool stands = foot.progress >= 1 && last[l].progress >= 1 && n > 0;
      const glm::dvec3 moved = foot.target - last[l].target + glm::dvec3(0, 0, body.world().y - before);
      if (stands) worst = std::max(worst, glm::length(moved));
      last[l] = foot;
    }
  }
  EXPECT_LT(worst, 1e-9);
}

TEST_F(Loop, blindBodyLiesOnTheGroundBelowItsHomes) {
  const auto slope = [](double x, double z) { return 0.3 * x - 0.2 * z; };
  terrain = field(129, 0.5f, slope);
  heights = validation::heightsOf(terrain, parametersFor(terrain));
  body.surfaceSpeed = body.speed = 0;
  for (int n = 0; n < 240; ++n)
    body = reference::blindBody(tuning, heights, creature, body, glm::dvec2(0, 0)).body;
  const glm::dvec3 up = body.orientation * glm::dvec3(0, 1, 0);
  EXPECT_NEAR(glm::length(up - glm::normalize(glm::dvec3(-0.3, 1, 0.2))), 0, 1e-3);
  EXPECT_NEAR(body.y, slope(0.5, 0.5), 1e-2);
  EXPECT_EQ(body.follow, 1);
}

TEST_F(Loop, blindBodyWaitsForNobody) {
  for (int n = 0; n < 60; ++n)
    body = reference::blindBody(tuning, heights, creature, body, glm::dvec2(0, 1)).body;
  const double before = body.world().y;
  for (int n = 0; n < 60; ++n)
    body = reference::blindBody(tuning, heights, creature, body, glm::dvec2(0, 1)).body;
  EXPECT_NEAR(body.world().y - before, 60 * tuning.dt, 1e-9);
}

}  // namespace
}  // namespace skitter::test

#include "cpu_reference/stages/react.h"

#include <gtest/gtest.h>

#include "cpu_reference/stages/body.h"
#include "reference_herd.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

using reference::ReactionPhase;

class React : public testing::Test {
 protected:
  reference::ReactResult tick(const std::optional<glm::dvec2>& push = {}, uint32_t idleBefore = 0,
                              reference::WatchedGround watched = nullptr) {
    const reference::ReactResult result = reference::react(tuning, heights, creature, body, reaction, steps,
                                                           misses, 10, push, watched, idleBefore);
    reaction = result.reaction;
    if (reaction.isLoose()) body = reference::looseBody(tuning, body, reaction);
    return result;
  }

  Heightfield field = flatField();
  shared::Parameters parameters = parametersFor(field);
  reference::Tuning tuning = validation::tuningOf(parameters);
  reference::Heights heights = validation::heightsOf(field, parameters);
  reference::Creature creature = spiderCreature();
  reference::AgentBody body = bodyAt(1, 1);
  std::vector<reference::Step> steps = stepsAtHome(creature, body);
  std::vector<double> misses = std::vector<double>(8);
  reference::Reaction reaction;
};

// sqrt(0.26 / 9.81)
constexpr double kFade = 0.16279916;

TEST_F(React, NobodyFallsWithoutADisturbance) {
  body.speed = 50;
  for (int i = 0; i < 100; ++i) tick();
  EXPECT_EQ(reaction.phase, ReactionPhase::steady);
  EXPECT_EQ(reaction.falls, 0);
}

TEST_F(React, APushThatIsCaughtCarriesTheBodyToTheCapturePoint) {
  EXPECT_NEAR(reference::pendulumTime(tuning, {}), kFade, 1e-6);
  tick(glm::dvec2(1, 0));
  EXPECT_EQ(reaction.phase, ReactionPhase::stumbling);
  EXPECT_NEAR(reaction.velocity.x, 1 / (1 + tuning.dt / kFade), 1e-6);
  double way = 0;
  for (int i = 0; i < 120; ++i) {
    way += reaction.velocity.x * tuning.dt;
    tick();
  }
  // Implicit Euler goes as far as the exponential does.
  EXPECT_NEAR(way, kFade, 2e-3);
  EXPECT_EQ(reaction.phase, ReactionPhase::steady);
  EXPECT_EQ(reaction.velocity, glm::dvec2(0));
}

TEST_F(React, AFallBeginsAfterATenthOfASecondOutOfReach) {
  tick(glm::dvec2(20, 0));
  for (int i = 1; i < 6; ++i) {
    EXPECT_EQ(reaction.phase, ReactionPhase::stumbling) << i;
    EXPECT_EQ(reaction.velocity.x, 20);
    tick();
  }
  EXPECT_EQ(reaction.phase, ReactionPhase::falling);
  EXPECT_EQ(reaction.falls, 1);
  EXPECT_NEAR(reaction.way.x, 1, 1e-12);
}

TEST_F(React, AFallenBodyLiesOnItsHullAndStandsAgain) {
  tick(glm::dvec2(8, 0));
  double lowest = 1e9;
  int ticks = 0;
  for (; ticks < 300 && reaction.stands == 0; ++ticks) {
    const reference::ReactResult result = tick();
    if (!reaction.isFallen()) continue;
    for (int k = -1; k <= 1; ++k) {
      const glm::dvec3 hull = result.frame * glm::dvec3(0, tuning.bodyHeight, k * tuning.bodyRadius);
      lowest = std::min(lowest, body.y + hull.y);
    }
  }
  EXPECT_EQ(reaction.falls, 1);
  EXPECT_EQ(reaction.stands, 1);
  EXPECT_LT(ticks, 300);
  EXPECT_NEAR(lowest, tuning.bellyClearance, 1e-9);
  EXPECT_NEAR(reaction.downBefore, (ticks - 5) * tuning.dt, 2 * tuning.dt);
}

TEST_F(React, LostGroundAndLostLegsDisturb) {
  Heightfield sunk = field;
  for (float& height : sunk.heights) height -= 1;
  const reference::Heights below = validation::heightsOf(sunk, parameters);
  tick({}, 0, &below);
  EXPECT_EQ(reaction.disturbed, 1);
  reaction = {};
  tick({}, 0, &heights);
  EXPECT_EQ(reaction.disturbed, 0);
  creature.limbs[3].carries = false;
  tick({}, 0);
  EXPECT_EQ(reaction.disturbed, 1);
  reaction = {};
  tick({}, 1u << 3);
  EXPECT_EQ(reaction.disturbed, 0);
  misses[1] = 0.06;
  tick({}, 1u << 3);
  EXPECT_EQ(reaction.disturbed, 1);
}

TEST_F(React, TippingTurnsTheUpAxisTowardTheFall) {
  const glm::dmat3 frame = reference::tippedFrame({0, 1, 0}, {0, 1}, {1, 0}, 1);
  // A Cayley turn by 2 atan(1/2): its cosine is 0.6, its sine 0.8.
  EXPECT_NEAR(glm::length(frame[1] - glm::dvec3(0.8, 0.6, 0)), 0, 1e-12);
  EXPECT_NEAR(glm::length(frame[2] - glm::dvec3(0, 0, 1)), 0, 1e-12);
  EXPECT_NEAR(glm::determinant(frame), 1, 1e-12);
}

TEST_F(React, AHeavierBodyIsPushedLess) {
  creature.load = 3;
  tick(glm::dvec2(1, 0));
  EXPECT_NEAR(reaction.velocity.x, 0.25 / (1 + tuning.dt / kFade), 1e-6);
}

// The body's centre is 0.26 m above its origin.
TEST_F(React, ALoadOnTopMakesThePendulumLongerAndOneBelowShorter) {
  EXPECT_NEAR(reference::pendulumTime(tuning, {1, 0.78, 1}), 2 * kFade, 1e-6);
  EXPECT_NEAR(reference::pendulumTime(tuning, {0, -0.13, 0}), std::sqrt(0.5) * kFade, 1e-6);
  EXPECT_NEAR(reference::pendulumTime(tuning, {0, -5, 0}), 0.5 * kFade, 1e-6) << "but not than a quarter";
}

// A centre of mass that far out is beyond every leg, whatever the velocity.
TEST_F(React, ALoadFarOutFellsWhoIsDisturbed) {
  creature.centre = {3, 0, 0};
  for (int i = 0; i < 20; ++i) tick();
  EXPECT_EQ(reaction.falls, 0);
  tick(glm::dvec2(0.1, 0));
  for (int i = 0; i < 20; ++i) tick();
  EXPECT_EQ(reaction.falls, 1);
}

TEST_F(React, LegsOfAFallenCreatureFoldAndHomesOfAPushedOneAreAhead) {
  reaction.velocity = {1, 0};
  reaction.phase = ReactionPhase::stumbling;
  const auto pushed = reference::reactingCreature(tuning, creature, reaction, glm::dquat(1, 0, 0, 0));
  EXPECT_NEAR(pushed.limbs[2].home.x - creature.limbs[2].home.x, kFade, 1e-6);
  EXPECT_TRUE(pushed.limbs[2].carries);
  reaction.phase = ReactionPhase::falling;
  const auto fallen = reference::reactingCreature(tuning, creature, reaction, glm::dquat(1, 0, 0, 0));
  EXPECT_FALSE(fallen.limbs[2].carries);
  EXPECT_TRUE(fallen.limbs[2].folds);
  const glm::dvec3 root{0.1, 0.3, 0}, home{0.6, 0, 0};
  const reference::Foot foot =
      reference::foldedFoot(tuning, heights, root, home, bodyAt(1, 1), {.target = {1, 0, 0}}, 0.5);
  EXPECT_NEAR(foot.target.x, 0.5 * 1 + 0.5 * (0.1 + tuning.foldAside * 0.5), 1e-12);
  EXPECT_EQ(foot.progress, 0);
}

}  // namespace
}  // namespace skitter::test

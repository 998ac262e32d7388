#include "cpu_reference/stages/foothold.h"

#include <gtest/gtest.h>

#include "cpu_reference/heightfield.h"
#include "cpu_reference/stages/gait.h"
#include "cpu_reference/stages/swing.h"
#include "spider.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

class Foothold : public testing::Test {
 protected:
  void ground(const Heightfield& f) {
    terrain = f;
    heights = validation::heightsOf(terrain, parametersFor(terrain));
  }
  reference::FootholdResult lift(size_t l) const {
    return reference::foothold(tuning, heights, creature.limbs[l], body, gait, steps[l], true, 10);
  }
  glm::dvec3 landing(const reference::Step& step) const { return step.relative(step.landing, body); }

  Heightfield terrain = flatField();
  reference::Tuning tuning = validation::tuningOf(parametersFor(terrain));
  reference::Heights heights = validation::heightsOf(terrain, parametersFor(terrain));
  reference::Creature creature = spiderCreature();
  reference::AgentBody body = bodyAt(1, 1);
  std::vector<reference::Step> steps = stepsAtHome(creature, body);
  reference::Gait gait{0, 1, 0, 21, 0.12, 0.77, 0};
};

TEST_F(Foothold, flatGroundTakesThePrediction) {
  body.surfaceSpeed = body.speed = 0.5;
  body.turnRate = 0.2;
  for (size_t l = 0; l < 8; ++l) {
    const auto result = lift(l);
    EXPECT_FALSE(result.lastResort);
    EXPECT_EQ(result.candidates.size(), 24u);
    EXPECT_EQ(result.chosen, 11);
    EXPECT_NEAR(glm::length(landing(result.step) - result.target), 0, 1e-12);
    EXPECT_EQ(result.step.firstTick, 9);
    EXPECT_EQ(result.step.duration, 21);
  }
}

TEST_F(Foothold, predictionLiesAheadByHalfAStance) {
  body.surfaceSpeed = body.speed = 0.5;
  const double swingTime = 21 * tuning.dt, stance = gait.cycle - swingTime;
  const auto result = lift(0);
  EXPECT_NEAR(result.target.z - creature.limbs[0].home.z, 0.5 * (swingTime + stance / 2), 1e-12);
  EXPECT_NEAR(result.root.z - creature.limbs[0].root.z, 0.5 * swingTime, 1e-12);
}

TEST_F(Foothold, cliffIsAvoided) {
  // The ground falls away 3 m just short of the leg's home.
  const double edge = 1 + creature.limbs[1].home.x - 0.08;
  ground(field(513, 0.0625f, [=](double x, double) { return x > edge ? -3.0 : 0.0; }));
  const auto result = lift(1);
  EXPECT_FALSE(result.lastResort);
  EXPECT_FALSE(result.candidates[11].fits);
  EXPECT_NEAR(landing(result.step).y, 0, 1e-9);
  const double distance = glm::length(landing(result.step) - creature.limbs[1].root);
  EXPECT_LE(distance, tuning.reachMost + 1e-9);
  EXPECT_GE(distance, tuning.reachLeast - 1e-9);
}

TEST_F(Foothold, lastResortLiesOnTheGroundHoweverFarThatIs) {
  for (const float below : {-5.0f, -0.1f, 0.1f}) {
    ground(flatField(below));
    tuning.reachMost = tuning.reachLeast = below < -1 ? 0.95 : 0.01;
    const auto result = lift(2);
    EXPECT_TRUE(result.lastResort);
    EXPECT_LT(result.step.duration, 0);
    EXPECT_NEAR(landing(result.step).y, below, 1e-6);
  }
}

TEST_F(Foothold, lastResortFacesUpWhereAnythingDoes) {
  // A slope that faces the wrong way but is within reach, and level ground beyond it that is not.
  const double edge = 1 + creature.limbs[1].home.x;
  ground(field(513, 0.0625f, [=](double x, double) { return std::max(-8.0, 8 * std::min(0.0, edge - x)); }));
  tuning.reachLeast = tuning.reachMost = 0.01;
  const auto result = lift(1);
  EXPECT_TRUE(result.lastResort);
  EXPECT_GE(result.candidates[static_cast<size_t>(result.chosen)].facing, tuning.slopeLeast);
}

TEST_F(Foothold, nearestOnlyIgnoresEverythingElse) {
  ground(roughField());
  tuning.nearestOnly = true;
  for (size_t l = 0; l < 8; ++l) {
    const auto result = lift(l);
    for (const auto& candidate : result.candidates) {
      if (!candidate.fits) continue;
      EXPECT_LE(glm::length(result.candidates[static_cast<size_t>(result.chosen)].point - result.target),
                glm::length(candidate.point - result.target) + 1e-12);
    }
  }
}

// A passer that stands where the foot's home is leaves less than half of the way there; one that goes away
// leaves more.
TEST_F(Foothold, feetStayOnTheirSideOfWhoPasses) {
  ground(flatField(0));
  const glm::dvec3 home = creature.limbs[1].home;
  const glm::dvec2 side = glm::normalize(glm::dvec2(home.x, home.z));
  const double way = glm::length(glm::dvec2(home.x, home.z));
  reference::Passer passer{.place = side * way, .radius = 0.25 * way, .ownRadius = 0.25 * way};
  const auto reachAmong = [&] {
    const auto result = reference::foothold(tuning, heights, creature.limbs[1], body, gait, steps[1], true,
                                            10, {}, {}, std::span(&passer, 1));
    EXPECT_FALSE(result.lastResort);
    const glm::dvec3 at = landing(result.step) - landing(steps[1]) + home;
    return glm::dot(side, glm::dvec2(at.x, at.z)) / way;
  };
  const double alone = reachAmong();
  EXPECT_LT(alone, 0.7);
  passer.velocity = side * (10 * way / tuning.dt / 60);
  EXPECT_GT(reachAmong(), alone + 0.2);
}

TEST_F(Foothold, stepRisesOverWhatLiesBetween) {
  const glm::dvec3 home = creature.limbs[1].home;
  steps[1] = plantedAt(body, home + glm::dvec3(0, 0, -0.4));
  ground(field(1025, 0.03125f, [=](double, double z) {
    return std::clamp(0.35 - 2 * std::abs(z - (1 + home.z - 0.2)), 0.0, 0.25);
  }));
  const auto result = lift(1);
  EXPECT_FALSE(result.lastResort);
  EXPECT_GE(glm::length(result.step.lift), 0.25 + tuning.stepClearance - 1e-3);
  EXPECT_LE(glm::length(result.step.lift), tuning.stepHeightMax + 1e-12);
}

TEST_F(Foothold, aimingAnewKeepsTheFootsPlaceAndWay) {
  steps[0] = lift(0).step;
  body.surfaceSpeed = body.speed = 1;
  const double tick = 17;
  const auto result =
      reference::foothold(tuning, heights, creature.limbs[0], body, gait, steps[0], false, tick);
  const auto time = reference::eased(steps[0], steps[0].progress(tick - 1));
  const auto old = reference::splineAt(steps[0], time.progress);
  EXPECT_NEAR(
      glm::length(result.step.relative(result.step.liftOff, body) - steps[0].relative(old.position, body)), 0,
      1e-12);
  EXPECT_EQ(result.step.firstTick + result.step.duration, steps[0].firstTick + steps[0].duration);
  const auto now = reference::splineAt(result.step, 0);
  const double rate = reference::eased(result.step, 0).rate;
  EXPECT_NEAR(
      glm::length(now.tangent * rate / result.step.duration - old.tangent * time.rate / steps[0].duration), 0,
      1e-12);
}

TEST_F(Foothold, everyCandidateIsOnTheGround) {
  ground(roughField());
  const auto result = lift(5);
  const glm::dvec2 place = body.world();
  for (const auto& candidate : result.candidates) {
    EXPECT_NEAR(candidate.point.y + body.y,
                reference::heightAt(heights, place.x + candidate.point.x, place.y + candidate.point.z),
                1e-12);
  }
}

}  // namespace
}  // namespace skitter::test

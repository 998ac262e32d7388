#include "cpu_reference/stages/body.h"

#include <gtest/gtest.h>

#include "spider.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

class Body : public testing::Test {
 protected:
  // Ticks with the feet carried along under the body, on the ground.
  void walk(const glm::dvec2& desired, int ticks, const std::function<double(double, double)>& ground) {
    for (int i = 0; i < ticks; ++i) {
      steps.clear();
      const glm::dvec2 place = body.world();
      for (const reference::Limb& limb : creature.limbs) {
        glm::dvec3 home =
            glm::angleAxis(std::atan2(body.heading.x, body.heading.y), glm::dvec3(0, 1, 0)) * limb.home;
        home.y = ground(place.x + home.x, place.y + home.z) - body.y;
        steps.push_back(plantedAt(body, home));
      }
      body =
          reference::body(tuning, heights, creature, body, desired, steps, misses, ++tick, breathPhase).body;
    }
  }

  Heightfield terrain = flatField();
  reference::Tuning tuning = validation::tuningOf(parametersFor(terrain));
  reference::Heights heights = validation::heightsOf(terrain, parametersFor(terrain));
  reference::Creature creature = spiderCreature();
  reference::AgentBody body = bodyAt(0.5, 0.5);
  std::vector<reference::Step> steps;
  std::vector<double> misses = std::vector<double>(8);
  double tick = 0, breathPhase = 0;
};

double flat(double, double) { return 0; }

TEST_F(Body, straightWalkCoversItsSpeed) {
  walk({0, 1}, 60, flat);
  EXPECT_NEAR(body.speed, 1, 1e-9);
  const double before = body.world().y;
  walk({0, 1}, 120, flat);
  EXPECT_NEAR(body.world().y - before, 120 * tuning.dt, 1e-6);
  EXPECT_NEAR(body.world().x, 0.5, 1e-9);
  EXPECT_NEAR(body.y, 0, 1e-9);
  EXPECT_NEAR(body.surfaceSpeed, 1, 1e-9);
}

TEST_F(Body, accelerationIsBounded) {
  double speed = 0;
  for (int i = 0; i < 90; ++i) {
    walk(i < 45 ? glm::dvec2(0, 2) : glm::dvec2(0), 1, flat);
    EXPECT_LE(body.speed - speed, tuning.acceleration * tuning.dt + 1e-12);
    EXPECT_GE(body.speed - speed, -tuning.braking * tuning.dt - 1e-12);
    speed = body.speed;
  }
  EXPECT_EQ(speed, 0);
}

// A body that still turns, and wishes too little to turn to: its way is along the heading that it had.
TEST_F(Body, wishesTooSmallToTurnToAreAlongTheOldHeading) {
  const double wish = 0.5e-4 * tuning.legLength;
  body.turnRate = 40 * tuning.turnAcceleration * tuning.dt;
  walk({0, wish}, 1, flat);
  ASSERT_LT(body.heading.y, 0.999);
  EXPECT_NEAR(body.speed, wish * body.heading.y, 1e-12);
}

// Rounding decides whether a wish of just so much has a direction, so either choice can be asked for.
TEST_F(Body, wishesOnTheVergeOfADirectionCanBeDecidedEitherWay) {
  walk({0, 0}, 1, flat);
  const auto turned = [&](double wish, int goes) {
    return reference::body(tuning, heights, creature, body, glm::dvec2(wish * tuning.legLength, 0), steps,
                           misses, tick + 1, breathPhase, {.follow = {}, .turnSign = 0, .goes = goes});
  };
  EXPECT_LT(turned(1e-4, -1).goMargin, 1e-12);
  EXPECT_NEAR(turned(1.5e-4, -1).goMargin, 0.5, 1e-9);
  EXPECT_NE(turned(1e-4, 1).body.turnRate, 0);
  EXPECT_EQ(turned(1e-4, 0).body.turnRate, 0);
  EXPECT_NE(turned(1.001e-4, -1).body.turnRate, 0);
  EXPECT_EQ(turned(0.999e-4, -1).body.turnRate, 0);
}

TEST_F(Body, brakesBeforeTheEdgeAndNoEarlier) {
  tuning.halfExtentX = tuning.halfExtentZ = 20;
  for (const double side : {1.0, -1.0}) {
    body = bodyAt(0.5, 0.5);
    double fastest = 0, hardest = 0;
    for (int i = 0; i < 900; ++i) {
      const double before = body.speed;
      walk({0, 1000 * side}, 1, flat);
      fastest = std::max(fastest, body.speed);
      hardest = std::max(hardest, before - body.speed);
      EXPECT_LE(std::abs(body.world().y), 20);
    }
    EXPECT_GT(std::abs(body.world().y), 19.999);
    EXPECT_LE(hardest, tuning.braking * tuning.dt * (1 + 1e-9));
    // Braking takes as little of the way as it must: s^2 / (2 acceleration) + s^2 / (2 braking).
    const double way = 20 - 0.5;
    if (side < 0) continue;  // it turns round first
    EXPECT_NEAR(fastest, std::sqrt(2 * way / (1 / tuning.acceleration + 1 / tuning.braking)), 0.1);
  }
}

TEST_F(Body, stoppingSpeedLeavesATickToMove) {
  for (const double way : {0.0, 1e-6, 0.01, 1.0, 100.0}) {
    const double s = reference::stoppingSpeed(tuning, way);
    EXPECT_NEAR(s * s / (2 * tuning.braking) + s * tuning.dt, way, 1e-12 * (1 + way));
  }
}

TEST_F(Body, turnsTowardItsWayEitherSide) {
  for (const double side : {1.0, -1.0}) {
    body = bodyAt(0.5, 0.5);
    walk({side, 0}, 5, flat);
    EXPECT_GT(body.heading.x * side, 0);
    EXPECT_GT(body.turnRate * side, 0);
    walk({side, 0}, 180, flat);
    EXPECT_NEAR(body.heading.x, side, 1e-3);
    EXPECT_NEAR(glm::length(body.heading), 1, 1e-12);
    EXPECT_LT(std::abs(body.turnRate), 0.05);
    const glm::dvec3 forward = body.orientation * glm::dvec3(0, 0, 1);
    EXPECT_NEAR(forward.x, side, 1e-2);
  }
}

TEST_F(Body, turnsRoundWhenItsWayIsBehind) {
  walk({0, -1}, 300, flat);
  EXPECT_NEAR(body.heading.y, -1, 1e-3);
  EXPECT_NEAR(body.speed, 1, 1e-3);
}

TEST_F(Body, tiltConvergesToThePlane) {
  const auto slope = [](double x, double z) { return 0.3 * x - 0.2 * z; };
  terrain = field(129, 0.5f, slope);
  heights = validation::heightsOf(terrain, parametersFor(terrain));
  walk({0, 0}, 240, slope);
  const glm::dvec3 up = body.orientation * glm::dvec3(0, 1, 0);
  // A little more level than the ground.
  EXPECT_NEAR(glm::length(up - glm::normalize(glm::dvec3(-0.3 * 0.92, 1, 0.2 * 0.92))), 0, 1e-3);
  const glm::dvec3 forward = body.orientation * glm::dvec3(0, 0, 1);
  EXPECT_NEAR(forward.y / std::hypot(forward.x, forward.z), -0.2 * 0.92, 1e-3);
  EXPECT_NEAR(forward.x, 0, 1e-9);
  EXPECT_NEAR(body.y, slope(0.5, 0.5), 1e-2);
}

TEST_F(Body, bellyStaysAboveABump) {
  const auto bump = [](double x, double z) { return std::max(0.0, 0.4 - std::hypot(x - 0.5, z - 0.5)); };
  terrain = field(257, 0.125f, bump);
  heights = validation::heightsOf(terrain, parametersFor(terrain));
  walk({0, 0}, 120, flat);
  EXPECT_NEAR(body.y, 0.4 + std::max(-tuning.sinkMost, tuning.bellyClearance - tuning.bodyHeight), 1e-3);
}

// Its feet stay where the ground is level, as foothold keeps them.
TEST_F(Body, stopsBeforeWallsAndCliffsAndWalksOnWhenLedBack) {
  for (const double high : {5.0, -5.0}) {
    terrain = field(257, 0.125f, [&](double, double z) { return z > 3 ? high : 0; });
    heights = validation::heightsOf(terrain, parametersFor(terrain));
    body = bodyAt(0.5, 0.5);
    double fastest = 0;
    for (int i = 0; i < 400; ++i) {
      walk({0, 1}, 1, flat);
      fastest = std::max(fastest, body.speed);
      EXPECT_NEAR(body.y, 0, 1.01 * tuning.climbMost);
    }
    EXPECT_NEAR(fastest, 1, 1e-3);
    // The front end is in the ground's slope, which is a cell wide.
    EXPECT_NEAR(body.world().y + tuning.bodyRadius, 3, 0.2) << high;
    EXPECT_LT(body.follow, 0.05);
    EXPECT_LT(body.speed, 0.05);
    walk({0, -1}, 300, flat);
    EXPECT_LT(body.world().y, 1) << high;
    EXPECT_EQ(body.follow, 1);
  }
}

TEST_F(Body, goesAlongGroundThatIsTooSteepAndStopsWhereItLeadsStraightUp) {
  const auto slope = [](double x, double) { return 0.8 * x; };
  terrain = field(257, 0.25f, slope);
  heights = validation::heightsOf(terrain, parametersFor(terrain));
  for (const double maxSlope : {0.8, 0.6}) {
    tuning.maxSlope = maxSlope;
    body = bodyAt(0.5, 0.5);
    body.y = 0.4;
    const bool tooSteep = maxSlope < 0.7;
    walk({0.5, 0.5}, 240, slope);
    EXPECT_GT(body.world().y, 1.5);
    if (tooSteep) {
      EXPECT_NEAR(body.world().x, 0.5, 0.05);
    } else {
      EXPECT_GT(body.world().x, 1.5);
    }
    const double before = body.world().x;
    walk({0.5, 0}, 120, slope);
    EXPECT_NEAR(body.speed, tooSteep ? 0 : 0.5, 1e-2);
    EXPECT_EQ(body.world().x > before + 0.3, !tooSteep);
  }
}

TEST_F(Body, isNeverFarFromTheGroundWhereverItsFeetAre) {
  for (const double feet : {-50.0, 50.0}) {
    body = bodyAt(0.5, 0.5);
    walk({0, 1}, 120, [&](double, double) { return feet; });
    EXPECT_GE(body.y, -1.5 * tuning.sinkMost);
    EXPECT_LE(body.y, tuning.riseMost);
  }
}

TEST_F(Body, stretchedLegBehindHoldsTheBodyAndOneAheadDoesNot) {
  steps = stepsAtHome(creature, body);
  steps[0] = plantedAt(body, creature.limbs[0].root + glm::dvec3(0, -0.26, -0.98));
  const auto held = reference::body(tuning, heights, creature, body, glm::dvec2(0, 1), steps, misses, 1);
  EXPECT_LT(held.body.follow, 0.5);
  const auto free = reference::body(tuning, heights, creature, body, glm::dvec2(0, -1), steps, misses, 1);
  EXPECT_EQ(free.body.follow, 1);
}

TEST_F(Body, footThatCannotFollowHoldsTheBody) {
  steps = stepsAtHome(creature, body);
  misses[3] = tuning.errorStop / 2;
  EXPECT_NEAR(
      reference::body(tuning, heights, creature, body, glm::dvec2(0, 1), steps, misses, 1).body.follow, 0.5,
      1e-6);
  steps[3].firstTick = 0;
  steps[3].duration = 20;
  EXPECT_EQ(reference::body(tuning, heights, creature, body, glm::dvec2(0, 1), steps, misses, 1).body.follow,
            1);
}

TEST_F(Body, leansIntoATurnAndComesUpright) {
  walk({0, 1}, 60, flat);
  walk({1, 1}, 20, flat);
  const glm::dvec3 leaning = body.orientation * glm::dvec3(0, 1, 0);
  // It turns to its left, +x, and its back goes that way.
  EXPECT_GT(body.turnRate, 0.1);
  EXPECT_GT(leaning.x, 0.005);
  EXPECT_LT(std::hypot(leaning.x, leaning.z), tuning.leanMost);
  walk({1, 1}, 240, flat);
  EXPECT_NEAR((body.orientation * glm::dvec3(0, 1, 0)).y, 1, 1e-6);
}

TEST_F(Body, breathesAtRestAndNotWhileItWalks) {
  double least = 1, most = -1;
  for (int i = 0; i < 240; ++i) {
    breathPhase = std::fmod(0.01 * i, 1);
    walk({0, 0}, 1, flat);
    if (i > 120) least = std::min(least, body.y), most = std::max(most, body.y);
  }
  EXPECT_GT(most - least, 0.7 * tuning.breathHeight);
  EXPECT_LT(most, tuning.breathHeight);
  EXPECT_GE(least, 0);
  for (int i = 0; i < 60; ++i) {
    breathPhase = std::fmod(0.01 * i, 1);
    walk({0, 1}, 1, flat);
  }
  EXPECT_NEAR(body.y, 0, 1e-4);
}

TEST_F(Body, tileFollowsTheBody) {
  body = bodyAt(15.99, 0.5);
  body.heading = {1, 0};
  body.orientation = glm::angleAxis(std::acos(0.0), glm::dvec3(0, 1, 0));
  walk({1, 0}, 60, flat);
  EXPECT_EQ(body.tileX, 1);
  EXPECT_LT(body.localX, 1);
  EXPECT_GE(body.localX, 0);
}

TEST_F(Body, standsStillOnlyAtRest) {
  walk({0, 0}, 30, flat);
  EXPECT_NEAR(body.still, 30 * tuning.dt, 1e-9);
  walk({0, 1}, 1, flat);
  EXPECT_EQ(body.still, 0);
}

}  // namespace
}  // namespace skitter::test

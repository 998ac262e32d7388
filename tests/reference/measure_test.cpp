// Motions whose figures are known in closed form.
#include "cpu_reference/stages/measure.h"

#include <gtest/gtest.h>

#include "spider.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

using reference::Metric;

constexpr double dt = 1.0 / 60;

class Measure : public testing::Test {
 protected:
  Measure() {
    tuning.dt = dt;
    for (size_t l = 0; l < creature.limbs.size(); ++l) {
      feet.push_back({{}, 1});
      chains.push_back({std::vector<glm::dvec2>(4), creature.limbs[l].home, 0, 1});
    }
  }

  const Metric& tick() {
    const auto measured =
        reference::measure(tuning, heights, creature, body, feet, chains, watchedFor++, watched, metric);
    watched = measured.watched;
    return metric = measured.metric;
  }
  // Leg 0's tip, the only one that moves.
  const Metric& tick(const glm::dvec3& tip, bool planted = true) {
    chains[0].tip = tip;
    feet[0].progress = planted ? 1 : 0.5;
    return tick();
  }
  void plantOnly(const std::vector<glm::dvec2>& tips) {
    for (size_t l = 0; l < feet.size(); ++l) {
      feet[l].progress = l < tips.size() ? 1 : 0;
      if (l < tips.size()) chains[l].tip = {tips[l].x, 0, tips[l].y};
    }
  }

  Heightfield terrain = flatField();
  reference::Tuning tuning = validation::tuningOf(parametersFor(terrain));
  reference::Heights heights = validation::heightsOf(terrain, parametersFor(terrain));
  reference::Creature creature = spiderCreature();
  reference::AgentBody body = bodyAt(1, 1);
  std::vector<reference::Foot> feet;
  std::vector<reference::Chain> chains;
  reference::Watched watched;
  Metric metric;
  uint64_t watchedFor = 0;
};

TEST_F(Measure, feetThatStayDoNothing) {
  for (int i = 0; i < 60; ++i) tick();
  EXPECT_EQ(metric.ticks, 60);
  EXPECT_EQ(metric.planted, 8 * 60);
  EXPECT_EQ(metric.stays, 8 * 59);
  for (const double none : {metric.skates, metric.slip, metric.stances, metric.penetration, metric.floating,
                            metric.footPath, metric.bodyPath, metric.unstable, metric.crossings})
    EXPECT_EQ(none, 0);
}

TEST_F(Measure, slipAddsUpAndEndsWithTheStance) {
  tick({0.5, 0.1, 0}, false);
  tick({0.5, 0, 0});
  tick({0.5, 0.3, 0.01});
  tick({0.51, 0, 0.01});
  EXPECT_NEAR(watched.tips[0].slip, 0.02, 1e-12);
  tick({0.6, 0.1, 0}, false);
  EXPECT_EQ(watched.tips[0].slip, reference::TipTrail::air);
  EXPECT_NEAR(metric.slip, 0.02, 1e-12);
  EXPECT_EQ(metric.stances, 1);
  tick({0.9, 0.1, 0}, false);
  EXPECT_EQ(metric.stances, 1);
  tick({0.9, 0, 0});
  EXPECT_EQ(watched.tips[0].slip, 0);
}

TEST_F(Measure, aStanceWhoseBeginningWasNotSeenDoesNotCount) {
  tick({0.5, 0, 0});
  tick({0.6, 0, 0});
  tick({0.6, 0.1, 0}, false);
  EXPECT_EQ(metric.stances, 0);
  EXPECT_EQ(metric.slip, 0);
  EXPECT_EQ(metric.skates, 1);  // that it slid was seen
}

TEST_F(Measure, aChangeOfTileIsNoSlip) {
  body = bodyAt(15.999, 1);
  tick({0.5, 0.1, 0}, false);
  tick({0.5, 0, 0});
  body = bodyAt(16.001, 1);
  for (reference::Chain& chain : chains) chain.tip.x -= 0.002;
  tick(chains[0].tip);
  EXPECT_NEAR(watched.tips[0].slip, 0, 1e-12);
  EXPECT_EQ(metric.skates, 0);
  EXPECT_NEAR(watched.body.first.x, 0.002, 1e-12);
}

TEST_F(Measure, skatesAboveTheSpeed) {
  for (const double speed : {0.0, 0.09, 0.11, -0.12})
    for (int i = 0; i < 10; ++i) tick(chains[0].tip + glm::dvec3(0, 0, speed * dt));
  EXPECT_EQ(metric.skates, 20);
}

TEST_F(Measure, depthCountsAlwaysAndHeightOnlyWhenPlanted) {
  tick({0.5, -0.02, 0});
  EXPECT_NEAR(metric.penetration, 0.02, 1e-12);
  EXPECT_NEAR(metric.penetrationBeyond, 0.015, 1e-8);
  tick({0.5, 0.03, 0});
  EXPECT_NEAR(metric.floating, 0.03, 1e-12);
  EXPECT_NEAR(metric.floatingBeyond, 0.025, 1e-8);
  tick({0.5, 0.5, 0}, false);
  EXPECT_NEAR(metric.floating, 0.03, 1e-12);
  tick({0.5, -0.004, 0});
  EXPECT_NEAR(metric.penetration, 0.024, 1e-12);
  EXPECT_NEAR(metric.penetrationBeyond, 0.015, 1e-8);
}

TEST_F(Measure, keepsTheLargestErrorAndViolation) {
  chains[0].reachError = 0.1;
  double& x = chains[0].directions[2].x;
  const double edge = creature.limbs[0].bones[2].tanHalfCone;
  x = edge;
  tick();
  EXPECT_NEAR(metric.largestViolation, 0, 1e-12);
  EXPECT_EQ(metric.violations, 0);
  x = std::tan(std::atan(edge) + 0.005);
  chains[0].reachError = 0.05;
  tick();
  EXPECT_NEAR(metric.largestViolation, 0.01, 1e-12);
  EXPECT_EQ(metric.violations, 1);
  EXPECT_EQ(metric.largestError, 0.1);
}

TEST_F(Measure, violationIsAnAngle) {
  const double edge = creature.limbs[0].bones[2].tanHalfCone;
  chains[0].directions[2] = {0, 40};  // bent back to within 0.05 rad of straight against its rest
  tick();
  EXPECT_NEAR(metric.largestViolation, 2 * (std::atan(40) - std::atan(edge)), 1e-12);
  EXPECT_LT(metric.largestViolation, 3.1415927);
}

// The third difference of t^3 is 6 dt^3, wherever it is taken.
TEST_F(Measure, jerkOfACubic) {
  const double speed = 0.7, cubic = 0.4;
  const auto x = [&](double t) { return speed * t + cubic * t * t * t; };
  for (int i = 0; i < 3 + 24 * 3; ++i) tick({x(i * dt), 0.2, 0.1}, false);
  double jerk = 0, paths = 0;
  for (int window = 0; window < 3; ++window) {
    const int first = 3 + 24 * window;
    const double path = x((first + 23) * dt) - x((first - 1) * dt);
    jerk += std::pow(0.4, 5) * 0.4 * std::pow(6 * cubic, 2);
    paths += path * path;
  }
  EXPECT_NEAR(metric.footJerk, jerk, 1e-6 * jerk);
  EXPECT_NEAR(metric.footPath, paths, 1e-6 * paths);
  EXPECT_EQ(metric.bodyPath, 0);
}

// From rest to rest in T by the smoothest way there is, x = 10 s^3 - 15 s^4 + 6 s^5: 720, whatever its
// length.
TEST_F(Measure, jerkOfTheSmoothestWay) {
  tuning.dt = 0.4 / 4000;
  tuning.jerkTicks = 4000;
  const auto x = [](double s) { return 0.3 * s * s * s * (10 - 15 * s + 6 * s * s); };
  // The window's first sample is the fourth.
  for (int i = 0; i < 4003; ++i) {
    const double s = std::max(0.0, (i - 2) / 4000.0);
    body.localZ = 1 + x(s);
    tick();
  }
  EXPECT_NEAR(metric.bodyPath, 0.09, 1e-6);
  EXPECT_NEAR(metric.bodyJerk / metric.bodyPath, 720, 5);
}

TEST_F(Measure, aShortWayIsNoJerk) {
  for (int i = 0; i < 60; ++i) tick({0.5 + 1e-4 * (i % 3), 0.2, 0.1}, false);
  EXPECT_EQ(metric.footPath, 0);
}

TEST_F(Measure, marginOfASquare) {
  plantOnly({{0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}, {0.5, -0.5}, {0.1, 0.2}});
  tick();
  EXPECT_NEAR(metric.margin, 0.5, 1e-12);
  EXPECT_NEAR(metric.leastMargin, 0.5, 1e-12);
  EXPECT_EQ(metric.unstable, 0);
  // Rolled by 30 degrees the centre, 0.26 above the ground, is 0.13 off.
  body.orientation = glm::angleAxis(glm::radians(30.0), glm::dvec3(0, 0, 1));
  tick();
  EXPECT_NEAR(metric.leastMargin, 0.5 - 0.13, 1e-8);
  plantOnly({{0.5, 0.5}, {-0.5, 0.5}, {-0.5, 0.3}});
  body.orientation = {1, 0, 0, 0};
  tick();
  EXPECT_LT(metric.leastMargin, 0);
  EXPECT_EQ(metric.unstable, 1);
}

TEST_F(Measure, fewerThanThreeFeet) {
  plantOnly({{0.3, 0}, {0.3, 0.5}});
  tick();
  EXPECT_NEAR(metric.leastMargin, -0.3, 1e-12);
  plantOnly({{0.3, 0.4}});
  tick();
  EXPECT_NEAR(metric.leastMargin, -0.5, 1e-12);
  plantOnly({});
  tick();
  EXPECT_EQ(metric.supported, 2);
  EXPECT_EQ(metric.unstable, 3);
}

TEST(StabilityMargin, insideOutsideAndDegenerate) {
  const std::vector<glm::dvec2> square = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 1}, {2, 1}, {0, 0}};
  EXPECT_NEAR(reference::stabilityMargin(square, {0.5, 1}), 0.5, 1e-12);
  EXPECT_NEAR(reference::stabilityMargin(square, {3, 1}), -1, 1e-12);
  EXPECT_NEAR(reference::stabilityMargin(square, {5, 6}), -5, 1e-12);
  EXPECT_NEAR(reference::stabilityMargin({{0, 0}, {1, 0}, {2, 0}}, {1, 0.5}), -0.5, 1e-12);
  EXPECT_NEAR(reference::stabilityMargin({{1, 1}}, {1, 0}), -1, 1e-12);
}

TEST(ReachOver, segmentsCrossTouchAndMiss) {
  EXPECT_GT(reference::reachOver({-1, 0}, {1, 0}, {0, -1}, {0, 1}), 0);
  EXPECT_EQ(reference::reachOver({-1, 0}, {1, 0}, {0, 0}, {0, 1}), 0);
  EXPECT_LT(reference::reachOver({-1, 0}, {1, 0}, {0, 0.1}, {0, 1}), 0);
  EXPECT_LT(reference::reachOver({-1, 0}, {1, 0}, {2, -1}, {2, 1}), 0);
}

TEST(Neighbour, isTheNextBehindOnTheSameSide) {
  const reference::Creature creature = spiderCreature();
  size_t last = 0;
  for (size_t l = 0; l < 8; ++l) {
    const size_t other = reference::neighbourOf(creature, l);
    if (other == 8) {
      ++last;
      continue;
    }
    const glm::dvec3 a = creature.limbs[l].home, b = creature.limbs[other].home;
    EXPECT_EQ(a.x < 0, b.x < 0);
    EXPECT_LT(b.z, a.z);
    for (const reference::Limb& between : creature.limbs)
      EXPECT_FALSE((between.home.x < 0) == (a.x < 0) && between.home.z < a.z && between.home.z > b.z);
  }
  EXPECT_EQ(last, 2u);
}

TEST_F(Measure, legsThatSwingOverTheirNeighbourCross) {
  tick();
  EXPECT_EQ(metric.crossings, 0);
  EXPECT_EQ(metric.pairs, 6);
  // The foremost leg of a side is turned to where the next one stands, and beyond.
  size_t front = 0;
  for (size_t l = 0; l < 8; ++l)
    if (creature.limbs[l].home.z > creature.limbs[front].home.z) front = l;
  for (const glm::dvec2& turned : {glm::dvec2(0.8, 0), {-0.8, 0}, {0, 0.8}, {0, -0.8}}) {
    chains[front].directions[0] = turned;
    tick();
  }
  EXPECT_GE(metric.crossings, 1);
}

TEST_F(Measure, segmentsBelowTheGround) {
  tick();
  const double standing = metric.deepest;
  body.y -= 0.5;
  tick();
  EXPECT_GT(metric.deepest, standing + 0.3);
  EXPECT_LE(metric.deepest, standing + 0.5 + 1e-12);
  EXPECT_GT(metric.depth, 8 * 0.3);
}

TEST(WatchTurn, everyAgentInItsTurn) {
  EXPECT_EQ(reference::watchTurn(1, 1).watched, 0u);
  EXPECT_EQ(reference::watchTurn(5000, 1).watched, 4999u);
  EXPECT_EQ(reference::watchTurn(5000, 1).turn, 0u);
  EXPECT_EQ(reference::watchTurn(128, 3).turn, 0u);
  EXPECT_EQ(reference::watchTurn(128, 3).watched, 127u);
  EXPECT_EQ(reference::watchTurn(129, 3).turn, 1u);
  EXPECT_EQ(reference::watchTurn(129, 3).watched, 0u);
  EXPECT_EQ(reference::watchTurn(1 + 3 * 128, 3).turn, 0u);
}

}  // namespace
}  // namespace skitter::test

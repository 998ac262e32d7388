// Goals of the whole simulation, on a device with synchronization validation: agents walk, feet hold.
#include <algorithm>
#include <cmath>

#include "crowd/simulation.h"

namespace skitter::test {
namespace {

using CrowdTest = GpuTest;

TEST_F(CrowdTest, WalksAtTheCommandedSpeedWithoutSlipping) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device(), ground, sceneOf(64));
  simulate(device(), crowd, 120);
  const HerdState start = crowd.download(0);
  simulate(device(), crowd, 300);
  const HerdState end = crowd.download(0);
  for (size_t agent = 0; agent < 64; ++agent) {
    const glm::dvec3 way = positionOf(end, agent) - positionOf(start, agent);
    EXPECT_GT(std::hypot(way.x, way.z), 0.9 * 5) << "agent " << agent;
  }
  // README: slip 0.006 % a stance, penetration and float 0.0001 %.
  const Fidelity f = crowd.fidelity();
  EXPECT_LT(f.slip, 6e-5);
  EXPECT_LT(f.skating, 1e-3);
  EXPECT_LT(f.penetration, 3e-6);
  EXPECT_LT(f.floating, 6e-6);
  EXPECT_LT(f.reachErrorP99, 1e-3);
  EXPECT_LT(f.limitViolation.value(), 1e-6);
  EXPECT_EQ(f.notFinite, 0u);
}

// The same figures of those who walk worse: none of them is small because nothing is measured.
TEST_F(CrowdTest, FeetThatKnowNothingOfTheGroundAreSeen) {
  Crowd crowd(device(), rollingGround(), sceneOf(64, 1, 1, Controller::loop));
  simulate(device(), crowd, 420);
  const Fidelity f = crowd.fidelity();
  EXPECT_GT(f.slip, 2e-3);
  EXPECT_GT(f.skating, 0.02);
  EXPECT_GT(f.penetration, 2e-3);
  EXPECT_GT(f.penetrationBeyond, 1e-3);
  EXPECT_GT(f.floating, 2e-3);
  EXPECT_GT(f.floatingBeyond, 1e-3);
}

TEST_F(CrowdTest, FeetThatMissTheirTargetsAreSeen) {
  Scene scene = sceneOf(64);
  scene.herds[0].solver = Solver::fabrik;
  Crowd crowd(device(), rollingGround(), scene);
  simulate(device(), crowd, 120);
  const Fidelity f = crowd.fidelity();
  EXPECT_GT(f.slip, 5e-3);
  EXPECT_GT(f.reachErrorP99, 0.1);
  EXPECT_GT(f.reachErrorMost, 0.2);
  EXPECT_GT(f.segmentPenetration, 1e-3);
}

Rig halfASpider() {
  Rig rig = spiderRig();
  const auto halve = [](auto& length) { length *= 0.5f; };
  halve(rig.legLength);
  halve(rig.bodyHeight);
  halve(rig.bodyRadius);
  for (Leg& leg : rig.legs) {
    halve(leg.home);
    halve(leg.reach);
    for (Bone& bone : leg.bones) {
      halve(bone.start);
      halve(bone.length);
    }
  }
  return rig;
}

TEST_F(CrowdTest, PercentileOfReachErrorsIsOfEveryLegAndTick) {
  Crowd crowd(device(), rollingGround(), sceneOf(16), {.rigs = {halfASpider()}});
  std::vector<double> errors;
  for (int tick = 0; tick < 60; ++tick) {
    simulate(device(), crowd, 1);
    const HerdState state = crowd.download(0);
    for (size_t leg = 0; leg < 16 * 8; ++leg) errors.push_back(state.tip.at(4 * leg + 3) / 0.5);
  }
  std::sort(errors.begin(), errors.end());
  const double percentile = errors[99 * errors.size() / 100];
  const Fidelity f = crowd.fidelity();
  EXPECT_DOUBLE_EQ(f.reachErrorMost, errors.back());
  EXPECT_GT(percentile, 1e-4);
  EXPECT_GT(f.reachErrorP99, (1 - 1e-5) * percentile);
  EXPECT_LT(f.reachErrorP99, (1 + 1e-5) * std::exp2(0.25) * percentile) << "the bucket's upper edge";
}

TEST_F(CrowdTest, PercentileIsNotAboveTheMost) {
  Scene scene = sceneOf(9);
  scene.herds[0].goal.kind = Goal::Kind::none;
  Crowd crowd(device(), flatGround(), scene);
  simulate(device(), crowd, 5);
  const Fidelity f = crowd.fidelity();
  EXPECT_LT(f.reachErrorMost, 1e-6);
  EXPECT_LE(f.reachErrorP99, f.reachErrorMost);
}

TEST_F(CrowdTest, TimesStagesWhileItIsToldTo) {
  if (!context().timestamps()) GTEST_SKIP() << "the device has no timestamps";
  CrowdOptions options;
  options.timestamps = true;
  Crowd crowd(device(), flatGround(), sceneOf(8), options);
  const auto namesAfterATick = [&] {
    simulate(device(), crowd, 1);
    std::vector<std::string> names;
    for (const StageTime& time : crowd.stageTimes()) names.push_back(time.stage);
    return names;
  };
  const std::vector<std::string> all = namesAfterATick();
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all.front(), "navigate+body+gait");
  crowd.timeStages(false);
  EXPECT_EQ(crowd.stageTimes().size(), all.size());  // of the last tick still
  EXPECT_TRUE(namesAfterATick().empty());
  crowd.timeStages(true);
  EXPECT_TRUE(crowd.stageTimes().empty());
  EXPECT_EQ(namesAfterATick(), all);
}

TEST_F(CrowdTest, BodiesFollowTheSlope) {
  // A plane that rises one in two across the way: bodies must come to lie parallel to it.
  Heightfield slope = flatGround();
  for (uint32_t row = 0; row < slope.rows; ++row)
    for (uint32_t column = 0; column < slope.columns; ++column)
      slope.heights[row * slope.columns + column] = 0.5f * slope.spacingX * static_cast<float>(column);
  Crowd crowd(device(), slope, sceneOf(8));
  simulate(device(), crowd, 240);
  const HerdState state = crowd.download(0);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.5, 1, 0));
  for (size_t agent = 0; agent < 8; ++agent) {
    const float* q = state.body.data() + agent * 16 + 8;
    const glm::dvec3 up(2.0 * (q[0] * q[1] - q[3] * q[2]), 1 - 2.0 * (q[0] * q[0] + q[2] * q[2]),
                        2.0 * (q[1] * q[2] + q[3] * q[0]));
    EXPECT_GT(glm::dot(up, normal), 0.999) << "agent " << agent;
    EXPECT_NEAR(positionOf(state, agent).y, slope.at(float(positionOf(state, agent).x), 0), 0.02);
  }
}

TEST_F(CrowdTest, ReachesAPointAndStands) {
  Scene scene = sceneOf(9);
  scene.herds[0].spawn.kind = Spawn::Kind::grid;
  scene.herds[0].spawn.heading = 3;  // nearly away from the target: it must turn around first
  scene.herds[0].goal = {.kind = Goal::Kind::point, .target = {0, 12}, .speed = 1};
  Crowd crowd(device(), flatGround(), scene);
  simulate(device(), crowd, 1500);
  const HerdState arrived = crowd.download(0);
  for (size_t agent = 0; agent < 9; ++agent) {
    const glm::dvec3 p = positionOf(arrived, agent);
    EXPECT_LT(std::hypot(p.x, p.z - 12), 0.6) << "agent " << agent;
  }
  simulate(device(), crowd, 120);
  const HerdState later = crowd.download(0);
  EXPECT_EQ(later.step, arrived.step) << "somebody stepped while standing";
}

TEST_F(CrowdTest, TurnsBackAtTheFarSide) {
  const Heightfield ground = flatGround();
  Crowd crowd(device(), ground, sceneOf(4, 2));
  double farthest = -1e9, last = 0;
  for (int i = 0; i < 40; ++i) {
    simulate(device(), crowd, 60);
    last = positionOf(crowd.download(0), 0).z;
    farthest = std::max(farthest, last);
    EXPECT_LT(std::abs(last), ground.extentZ() / 2);
  }
  EXPECT_LT(last, farthest - 2);
}

TEST_F(CrowdTest, StopsBeforeACliffAndGoesBackWhenItIsLedBack) {
  Crowd crowd(device(), cliffGround(), sceneOf(8));
  crowd.steer(0, Goal{.kind = Goal::Kind::velocity, .velocity = {0, 1}});
  simulate(device(), crowd, 2400);
  const HerdState stopped = crowd.download(0);
  // The ground ends a cell before the row that lies below.
  const double edge = cliffGround().originZ() + cliffGround().spacingZ * (cliffGround().rows / 4 - 1.0);
  for (size_t agent = 0; agent < 8; ++agent) {
    EXPECT_LT(positionOf(stopped, agent).z, edge) << "agent " << agent;
    EXPECT_GT(positionOf(stopped, agent).z, edge - 2) << "agent " << agent;
    // docs/stages/body.md: less than followLeast says that the ground stops it.
    EXPECT_LT(stopped.body[16 * agent + 14], 0.05f) << "agent " << agent;
  }
  crowd.steer(0, Goal{.kind = Goal::Kind::velocity, .velocity = {0, -1}});
  simulate(device(), crowd, 300);
  for (size_t agent = 0; agent < 8; ++agent)
    EXPECT_LT(positionOf(crowd.download(0), agent).z, edge - 2) << "agent " << agent;
}

}  // namespace
}  // namespace skitter::test

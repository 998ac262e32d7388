// Tuning values: what they are for a leg length and a tick, and which hold while a crowd lives because
// pipelines are specialised by them.
#include "crowd/tuning.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "crowd/herd.h"
#include "crowd/simulation.h"
#include "skitter/error.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

TEST(KnownParameters, DoNotFollowTheTick) {
  const auto tuning = [](float dt) {
    return crowd::tuningFor({}, spiderRig(), crowd::ikPlanFor(Solver::activeSet), rollingGround(), dt);
  };
  const shared::Parameters slow = tuning(1.0f / 20), quick = tuning(1.0f / 240);
  EXPECT_NE(slow.heightBlend, quick.heightBlend);
#define EXPECT_KNOWN(number, name) EXPECT_EQ(slow.name, quick.name) << #name;
  KNOWN_PARAMETERS(EXPECT_KNOWN)
#undef EXPECT_KNOWN
}

TEST(KnownParameters, HaveNumbersOfTheirOwn) {
  std::set<int> numbers;
#define EXPECT_NEW(number, name) EXPECT_TRUE(numbers.insert(number).second) << #name;
  KNOWN_PARAMETERS(EXPECT_NEW)
#undef EXPECT_NEW
}

struct Value {
  const char* name;
  float shared::Parameters::*member;
  double expected;
};

// E = exp(dt [0, 1; -omega^2, -2 zeta omega]) as a power series.
glm::dmat2 springOver(double dt, double omega, double zeta) {
  const glm::dmat2 rates(0, -omega * omega, 1, -2 * zeta * omega);
  glm::dmat2 sum(1), term(1);
  for (int k = 1; k < 60; ++k) {
    term = term * rates * (dt / k);
    sum += term;
  }
  return sum;
}

// A spider with legs of L metres on 65 x 33 samples of 0.5 m x 0.25 m. The reference is given the same
// values as the device, so no replay sees one that is wrong.
std::vector<Value> spiderValues(double L, double dt) {
  const glm::dmat2 spring = springOver(dt, 45, std::sqrt(0.5));
#define VALUE(name, expected) \
  { #name, &shared::Parameters::name, expected }
  return {
      VALUE(dt, dt),
      VALUE(legLength, L),
      VALUE(homeRadius, L * std::hypot(0.437588715, 0.540691665)),
      VALUE(bodyHeight, 0.27 * L),
      VALUE(bodyRadius, 0.34 * L),
      VALUE(originX, -16),
      VALUE(originZ, -4),
      VALUE(inverseSpacingX, 2),
      VALUE(inverseSpacingZ, 4),
      VALUE(halfExtentX, 16),
      VALUE(halfExtentZ, 4),
      VALUE(edgeMargin, std::min(2 * L, 0.2 * 8)),
      VALUE(slowRadius, L),
      VALUE(acceleration, 2.5 * L),
      VALUE(braking, 6 * L),
      VALUE(turnRate, 1.5),
      VALUE(turnAcceleration, 8),
      VALUE(turnGain, 4),
      VALUE(stretchSlow, 0.93),
      VALUE(stretchStop, 1),
      VALUE(errorStop, 0.02),
      VALUE(followLeast, 0.1),
      VALUE(heightBlend, 1 - std::exp(-dt / 0.10)),
      VALUE(tiltBlend, 1 - std::exp(-dt / 0.15)),
      VALUE(maxSlope, 2.75),
      VALUE(bellyClearance, 0.6 * 0.27 * L),
      VALUE(ridge, 1e-4 * L * L),
      VALUE(leanGain, 0.06 / L),
      VALUE(leanMost, 0.12),
      VALUE(leanLevel, 0.08),
      VALUE(breathHeight, 0.012 * L),
      VALUE(halfStrideStill, 0.08 * L),
      VALUE(halfStrideMax, 0.30 * L),
      VALUE(dutyStill, 0.75),
      VALUE(dutyGain, 0.05 / L),
      VALUE(dutyLeast, 0.55),
      VALUE(lagShare, 1.2),
      VALUE(swingStill, 0.35),
      VALUE(swingSpeed, 1.7 * L),
      VALUE(cycleMax, 1.2),
      VALUE(windowSlack, 1.1),
      VALUE(windowOpen, 0.5),
      VALUE(liftShare, 0.35),
      VALUE(stretchLift, 0.95),
      VALUE(strayShare, 1.8),
      VALUE(errorLift, 1e-3),
      VALUE(rootShare, 0.25),
      VALUE(settleTime, 1),
      VALUE(sleepTime, 2),
      VALUE(reaimDistance, 0.15 * L),
      VALUE(reaimLatest, 0.7),
      VALUE(groundTolerance, 0.02 * L),
      VALUE(reachTriggered, 0),
      VALUE(reachMost, 0.95),
      VALUE(reachLeast, 0.30),
      VALUE(reachComfort, 0.85),
      VALUE(slopeLeast, 0.35),
      VALUE(slopeWeight, 0.05),
      VALUE(reachWeight, 4),
      VALUE(nearestOnly, 0),
      VALUE(stepHeight, 0.12 * L),
      VALUE(stepClearance, 0.03 * L),
      VALUE(stepHeightMax, 0.5 * L),
      VALUE(routeWidth, 0.08 * L),
      VALUE(clipFade, dt / 0.25),
      VALUE(clipIdle, 0.05 * L),
      VALUE(clipHysteresis, 0.25),
      VALUE(clipRateMost, 2.5),
      VALUE(plantStray, 0.35 * L),
      VALUE(plantKeep, std::exp(-dt / 0.08)),
      VALUE(poseKeys, 0),  // of the key poses, which a herd without controller key-poses has not
      VALUE(poseStride, 0),
      VALUE(poseWalk, 0.1 * L),
      VALUE(springFrequency, 45),
      VALUE(springDamping, std::sqrt(0.5)),
      VALUE(springKeep, spring[0][0]),
      VALUE(springDrift, spring[1][0]),
      VALUE(springPull, spring[0][1]),
      VALUE(springCarry, spring[1][1]),
      VALUE(approachError, 0.25),
      VALUE(restPull, 0.05),
      VALUE(pullError, 0.1),
      VALUE(ikTolerance, 2e-5),
      VALUE(missLeast, 2e-4),
      VALUE(fallTime, 0.1),
      VALUE(slideFriction, 0.6),
      VALUE(lieTime, 0.5),
      VALUE(riseTime, 0.5),
      VALUE(gravity, 9.81),
      VALUE(disturbTime, 1),
      VALUE(slipMiss, 0.05),
      VALUE(steadySpeed, 1e-3 * L),
      VALUE(tumbleRate, 9),
      VALUE(tumbleDamping, 0.6),
      VALUE(lieAngle, 1.2),
      VALUE(tiltMost, 1.5),
      VALUE(uprightTilt, 0.05),
      VALUE(restSpeed, 0.1 * L),
      VALUE(restRate, 1),
      VALUE(wallSlope, 4),
      VALUE(wallLeast, 1e-3 * L),
      VALUE(foldTime, 0.3),
      VALUE(foldAside, 0.6),
      VALUE(foldBelow, 0.25),
      VALUE(sinkMost, 0.1 * L),
      VALUE(riseMost, 1 * L),
      VALUE(climbMost, 0.6 * L),
      VALUE(gapMost, 1.8 * L),
      VALUE(deadZone, 0.005 * L),
      VALUE(skateSpeed, 0.1 * L),
      VALUE(limitDeadZone, 1e-4),
      VALUE(jerkTicks, std::round(0.4 / dt)),
      VALUE(jerkPath, 0.05 * L),
  };
#undef VALUE
}

TEST(Tuning, FollowsLegLengthAndTick) {
  Heightfield oblong = generateHeightfield({.columns = 65, .rows = 33});
  oblong.spacingX = 0.5f;
  oblong.spacingZ = 0.25f;
  for (const float legLength : {1.0f, 0.66f})
    for (const float dt : {1.0f / 60, 0.07f}) {
      const Rig rig = scaledSpider(legLength);
      const shared::Parameters tuning =
          crowd::tuningFor({}, rig, crowd::ikPlanFor(Solver::activeSet), oblong, dt);
      const std::vector<Value> values = spiderValues(legLength, dt);
      EXPECT_EQ(values.size() * sizeof(float), sizeof tuning) << "a value is not here";
      for (const Value& value : values)
        EXPECT_NEAR(tuning.*value.member, value.expected, 1e-5 * std::abs(value.expected) + 1e-12)
            << value.name << " of " << legLength << " m, " << dt << " s";
    }
  // Without a polish the approach goes all the way.
  const shared::Parameters compared =
      crowd::tuningFor({}, spiderRig(), crowd::ikPlanFor(Solver::fabrik), oblong, kTick);
  EXPECT_EQ(compared.approachError, compared.ikTolerance);
}

// By name.
std::map<std::string, float> parametersOf(const Tuning& tuning) {
  static const Heightfield ground = smallRollingGround();
  const shared::Parameters p =
      crowd::tuningFor(tuning, scaledSpider(2), crowd::ikPlanFor(Solver::activeSet), ground, kTick);
  return {
#define NAMED(name) {#name, p.name},
      PARAMETERS(NAMED)
#undef NAMED
  };
}

TEST(Tuning, EachReachesItsParameterAlone) {
  // Where that is not the one of the same name alone.
  const std::map<std::string, std::set<std::string>> others = {
      {"heightTime", {"heightBlend"}},
      {"tiltTime", {"tiltBlend"}},
      {"fadeTime", {"clipFade"}},
      {"plantTime", {"plantKeep"}},
      {"springFrequency", {"springFrequency", "springKeep", "springDrift", "springPull", "springCarry"}},
      {"springDamping", {"springDamping", "springKeep", "springDrift", "springPull", "springCarry"}}};
  const std::map<std::string, float> usual = parametersOf({});
  for (const TuningInfo& info : allTunings) {
    Tuning tuning;
    tuning.*info.member = 0.7f * info.usual + 0.3f * info.least;
    const std::map<std::string, float> changed = parametersOf(tuning);
    std::set<std::string> names;
    for (const auto& [name, value] : changed)
      if (value != usual.at(name)) names.insert(name);
    const auto found = others.find(info.name);
    EXPECT_EQ(names, found == others.end() ? std::set<std::string>{info.name} : found->second) << info.name;
    // In metres, as the default is.
    if (found != others.end()) continue;
    EXPECT_NEAR(changed.at(info.name) / usual.at(info.name), tuning.*info.member / info.usual, 1e-6)
        << info.name;
  }
}

TEST(Tuning, TurnsBackNoFurtherInsideThanAFifthOfTheTerrain) {
  Tuning tuning;
  tuning.edgeMargin = 100;
  const Heightfield ground = smallRollingGround();
  const shared::Parameters p =
      crowd::tuningFor(tuning, spiderRig(), crowd::ikPlanFor(Solver::activeSet), ground, kTick);
  EXPECT_FLOAT_EQ(p.edgeMargin, 0.2f * ground.extentX());
}

using TuningTest = GpuTest;

// Mean over the legs of the highest point of a foot above where it stood before.
double liftOf(Device& device, const Tuning& tuning) {
  Scene scene = sceneOf(8);
  scene.herds[0].tuning = tuning;
  const Heightfield ground = flatGround();
  Crowd crowd(device, ground, scene, CrowdOptions{.feet = true});
  const auto legs = static_cast<size_t>(crowd.rig(0).legCount());
  std::vector<double> highest(8 * legs, -1e9);
  simulate(device, crowd, 60);
  for (int tick = 0; tick < 60; ++tick) {
    simulate(device, crowd, 1);
    const HerdState state = crowd.download(0);
    for (size_t leg = 0; leg < highest.size(); ++leg) {
      const double body = positionOf(state, leg / legs).y;
      highest[leg] = std::max(highest[leg], body + validation::footOf(state, leg).target.y);
    }
  }
  double sum = 0;
  for (const double each : highest) sum += each - ground.at(0, 0);
  return sum / static_cast<double>(highest.size());
}

TEST_F(TuningTest, AHigherStepLiftsTheFeetHigher) {
  Tuning low, high;
  low.stepHeight = 0.05f;
  high.stepHeight = 0.2f;
  // The lift vector of a step is its greatest height, by docs/stages/swing.md.
  const double usual = liftOf(device(), {});
  EXPECT_NEAR(liftOf(device(), low) / usual, 0.05 / 0.12, 0.04);
  EXPECT_NEAR(liftOf(device(), high) / usual, 0.2 / 0.12, 0.1);
}

TEST_F(TuningTest, ATunedHerdAgreesWithTheReference) {
  Scene scene = sceneOf(32, 1.5f);
  scene.herds.resize(2, scene.herds[0]);
  Tuning& tuning = scene.herds[1].tuning;
  tuning.stepHeight = 0.3f;
  tuning.swingStill = 0.6f;
  tuning.halfStrideMax = 0.2f;
  tuning.turnRate = 0.7f;
  tuning.reachMost = 0.9f;
  tuning.heightTime = 0.4f;
  Crowd crowd(device(), rollingGround(), scene);
  EXPECT_EQ(implOf(crowd).kinds.size(), 2u);
  for (const auto& herd : replayAll(device(), crowd, rollingGround(), 120)) expectAllPass(herd);
}

// Moves what is in order with `moved`, so that it stays so.
void putInOrder(float Tuning::*moved, Tuning& tuning) {
  for (const TuningOrder& order : allTuningOrders) {
    float &less = tuning.*order.lessMember, &more = tuning.*order.moreMember;
    if (more - less >= order.apart) continue;
    if (order.lessMember == moved)
      more = less + order.apart;
    else
      less = more - order.apart;
  }
}

TEST_F(TuningTest, EndsOfRangesAgreeWithTheReference) {
  Herd herd;
  herd.agents = 8;
  // They turn, walk, slow down and stand.
  herd.goal = {.kind = Goal::Kind::point, .target = {0, 2}, .speed = 1.5f};
  herd.spawn = {.kind = Spawn::Kind::grid, .spacing = 2, .centre = {0, 0}, .heading = 2.5f};
  // Each herd has a sixth of the parameters at their least, another sixth at their most, so that six herds
  // have had both ends of all.
  Scene scene = sceneOf(0);
  scene.herds.assign(6, herd);
  for (size_t h = 0; h < scene.herds.size(); ++h) {
    Tuning& tuning = scene.herds[h].tuning;
    for (size_t i = 0; i < allTunings.size(); ++i) {
      const TuningInfo& info = allTunings[i];
      if ((i + h) % 3 != 0) continue;
      tuning.*info.member = (i + h) % 6 == 0 ? info.least : info.most;
      putInOrder(info.member, tuning);
    }
  }
  const Heightfield ground = rollingGround();
  for (const Controller controller : allControllers) {
    SCOPED_TRACE(nameOf(controller));
    for (Herd& each : scene.herds) each.controller = controller;
    Crowd crowd(device(), ground, scene);
    const auto results = replayAll(device(), crowd, ground, 90);
    for (size_t h = 0; h < results.size(); ++h) {
      SCOPED_TRACE(h);
      expectAllPass(results[h]);
    }
  }
}

TEST_F(TuningTest, ACrowdRefusesWhatIsOutOfRange) {
  Scene scene = sceneOf(1);
  scene.name = "mine";
  scene.herds.resize(2, scene.herds[0]);
  const auto refusal = [&] {
    try {
      Crowd crowd(device(), rollingGround(), scene);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::input);
      return std::string(error.what());
    }
    return std::string("was taken");
  };
  scene.herds[1].tuning.stepHeight = 9;
  EXPECT_EQ(refusal(), "mine: herds[1].tuning.stepHeight is 9, expected 0.01 to 1 leg lengths");
  scene.herds[1].tuning = {.dutyStill = 0.6f, .dutyLeast = 0.7f};
  EXPECT_THAT(refusal(), ::testing::HasSubstr("mine: herds[1].tuning.dutyLeast is 0.7 and dutyStill is 0.6"));
}

}  // namespace
}  // namespace skitter::test

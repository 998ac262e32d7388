// Herds with ways keep off threats (docs/ways.md).
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "assets/files.h"
#include "crowd/herd.h"
#include "crowd/radius.h"
#include "crowd/simulation.h"
#include "skitter/error.h"
#include "skitter/state.h"
#include "validation/herd_facts.h"

namespace skitter::test {
namespace {

using ThreatsTest = GpuTest;
using ThreatsReplayTest = GpuLoadTest;

// On their way to a place in the north.
Scene northward(uint32_t agents, float speed = 2) {
  Scene scene = sceneOf(agents, 2);
  scene.herds[0].ways = Ways{};
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 1, .centre = {0, -10}};
  scene.herds[0].goal = {.kind = Goal::Kind::point, .target = {0, 12}, .speed = speed};
  return scene;
}

// Metres from the threat's edge to the nearest of the herd's agents.
double nearestTo(const Crowd& crowd, const Threat& threat, uint32_t herd = 0) {
  const HerdState state = crowd.download(herd);
  double nearest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < state.agents; ++i) {
    const glm::dvec3 at = positionOf(state, i);
    nearest = std::min(nearest, std::hypot(at.x - double{threat.centre.x}, at.z - double{threat.centre.y}) -
                                    double{threat.radius});
  }
  return nearest;
}

double southmost(const Crowd& crowd) {
  const HerdState state = crowd.download(0);
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < state.agents; ++i) least = std::min(least, positionOf(state, i).z);
  return least;
}

TEST_F(ThreatsTest, AreWalkedAround) {
  Scene scene = northward(9);
  scene.threats = {{.centre = {0, 0}, .radius = 4}};
  Crowd crowd(device(), flatGround(), scene);
  ASSERT_EQ(crowd.threats().size(), 1u);
  for (int part = 0; part < 90; ++part) {
    simulate(device(), crowd, 15);
    EXPECT_GT(nearestTo(crowd, crowd.threats()[0]), 0) << part;
  }
  EXPECT_GT(southmost(crowd), 11);
}

TEST_F(ThreatsTest, AreLeftByThoseInsideAndNotEnteredByOthers) {
  Crowd crowd(device(), flatGround(), northward(49));
  simulate(device(), crowd, 60);
  // Some are within it, others are more than a second's way from it.
  const Threat threat{.centre = {0, -4.5f}, .radius = 2.5f};
  const HerdState before = crowd.download(0);
  std::vector<bool> outside;
  for (size_t i = 0; i < before.agents; ++i) {
    const glm::dvec3 at = positionOf(before, i);
    outside.push_back(std::hypot(at.x, at.z + 4.5) > 2.5 + 2 + crowd::footprintRadius(crowd.rig(0)));
  }
  ASSERT_GT(std::ranges::count(outside, false), 0);
  ASSERT_GT(std::ranges::count(outside, true), 0);
  ASSERT_LT(nearestTo(crowd, threat), 0);
  crowd.setThreat(3, threat);
  for (int tick = 0; tick < 300; ++tick) {
    simulate(device(), crowd, 1);
    const HerdState state = crowd.download(0);
    for (size_t i = 0; i < state.agents; ++i) {
      const glm::dvec3 at = positionOf(state, i);
      if (outside[i]) {
        EXPECT_GT(std::hypot(at.x, at.z + 4.5), 2.5) << "agent " << i << ", tick " << tick;
      }
    }
  }
  EXPECT_GT(nearestTo(crowd, threat), 0);
}

// How many agents want to go the wrong way: from outside into the threat, from the outer half of it not out.
size_t goingWrong(const Crowd& crowd, const Threat& threat) {
  const HerdState state = crowd.download(0);
  const double radius = double{threat.radius};
  size_t wrong = 0;
  for (size_t i = 0; i < state.agents; ++i) {
    const glm::dvec3 at = positionOf(state, i);
    const float* steer = &state.steer[i * 4 * shared::STEER_STRIDE];
    const glm::dvec2 away(at.x - double{threat.centre.x}, at.z - double{threat.centre.y}),
        wanted(steer[0], steer[1]);
    const double apart = glm::length(away),
                 outward = glm::dot(away, wanted) / std::max(glm::length(wanted), 1e-9);
    if (apart > radius)
      wrong += outward < 0 && apart * apart - outward * outward < radius * radius;
    else
      wrong += apart > radius / 2 && outward < 0.5 * apart;
  }
  return wrong;
}

// The threat is not straight between agents and their goal: to the left and to the right of it are equally
// long ways for nobody.
TEST_F(ThreatsTest, ThatComeHaveAllRoutedAnewWithinASecond) {
  Crowd crowd(device(), flatGround(), northward(49));
  simulate(device(), crowd, 60);
  const Threat threat{.centre = {0.4f, -4.5f}, .radius = 2.5f};
  EXPECT_GT(goingWrong(crowd, threat), 49u / 2) << "it is dropped on their path";
  crowd.setThreat(0, threat);
  simulate(device(), crowd, 59);
  for (int tick = 60; tick < 120; ++tick) {
    simulate(device(), crowd, 1);
    EXPECT_EQ(goingWrong(crowd, threat), 0u) << "tick " << tick;
  }
}

TEST_F(ThreatsTest, GoAgain) {
  Scene scene = northward(4);
  Crowd never(device(), flatGround(), scene);
  scene.threats = {{.centre = {0, -2}, .radius = 5}};
  scene.events = {{0, ThreatChange{.number = 0, .threat = {.radius = 0}}}};
  Crowd gone(device(), flatGround(), scene);
  for (Crowd* crowd : {&never, &gone}) simulate(device(), *crowd, 60);
  EXPECT_TRUE(gone.threats().empty());
  EXPECT_EQ(never.stateHash(), gone.stateHash());
  gone.setThreat(1, {.centre = {0, 0}, .radius = 2});
  for (Crowd* crowd : {&never, &gone}) simulate(device(), *crowd, 60);
  EXPECT_NE(never.stateHash(), gone.stateHash());
}

TEST_F(ThreatsTest, EventsAreWhatTheCallerCouldDo) {
  Scene scene = northward(6);
  Crowd told(device(), flatGround(), scene);
  scene.events = {{0, ThreatChange{.number = 2, .threat = {{1, -4}, 2}}},
                  {0.5f, ThreatChange{.number = 2, .threat = {{-1, -2}, 3}}}};
  Crowd happened(device(), flatGround(), scene);
  told.setThreat(2, {{1, -4}, 2});
  simulate(device(), told, 29);
  told.setThreat(2, {{-1, -2}, 3});
  simulate(device(), told, 61);
  simulate(device(), happened, 90);
  EXPECT_EQ(told.stateHash(), happened.stateHash());
}

// Spiders that stand in the way of others.
Scene hunted(float threat) {
  Scene scene = northward(9);
  Herd hunter = sceneOf(2).herds[0];
  hunter.threat = threat;
  hunter.spawn = {.kind = Spawn::Kind::grid, .spacing = 2, .centre = {0, 0}};
  hunter.goal = {.kind = Goal::Kind::velocity, .velocity = {0, -0.3f}};
  scene.herds.push_back(hunter);
  return scene;
}

TEST_F(ThreatsTest, AgentsOfAHerdAre) {
  const auto closest = [&](float threat) {
    Crowd crowd(device(), flatGround(), hunted(threat));
    double nearest = std::numeric_limits<double>::infinity();
    for (int part = 0; part < 60; ++part) {
      simulate(device(), crowd, 10);
      const HerdState hunters = crowd.download(1);
      for (size_t i = 0; i < hunters.agents; ++i) {
        const glm::dvec3 at = positionOf(hunters, i);
        nearest = std::min(nearest, nearestTo(crowd, {.centre = {at.x, at.z}, .radius = 0}));
      }
    }
    return nearest;
  };
  EXPECT_LT(closest(0), 1.5);
  // They and their threats go so far between two looks.
  EXPECT_GT(closest(3), 3 - 0.25 * (2 + 0.3));
}

TEST_F(ThreatsTest, ACrowdOfAStateKeepsThem) {
  Scene scene = hunted(3);
  scene.threats = {{.centre = {6, -3}, .radius = 2}};
  Crowd crowd(device(), flatGround(), scene);
  crowd.setThreat(2, {.centre = {-6, -3}, .radius = 2});
  simulate(device(), crowd, 50);
  crowd.setThreat(0, {.centre = {5, -2}, .radius = 2});
  Crowd again(device(), parseState(crowd.saveToMemory(), "a state"));
  EXPECT_EQ(again.threats(), crowd.threats());
  for (Crowd* each : {&crowd, &again}) simulate(device(), *each, 70);
  EXPECT_EQ(crowd.stateHash(), again.stateHash());
}

TEST_F(ThreatsTest, AreNothingToHerdsWithoutWays) {
  Scene scene = hunted(3), alone = hunted(0);
  scene.herds[0].ways = alone.herds[0].ways = {};
  scene.threats = {{.centre = {0, 0}, .radius = 4}};
  Crowd among(device(), flatGround(), scene), without(device(), flatGround(), alone);
  for (Crowd* crowd : {&among, &without}) simulate(device(), *crowd, 60);
  EXPECT_EQ(among.stateHash(), without.stateHash());
}

TEST_F(ThreatsTest, AreRefusedWhereTheyAreNone) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Crowd crowd(device(), flatGround(), northward(1));
  const auto faultOf = [&](uint32_t number, const Threat& threat) {
    return inputFault([&] { crowd.setThreat(number, threat); });
  };
  EXPECT_EQ(faultOf(64, {}), "threat 64: expected a number less than 64");
  EXPECT_EQ(faultOf(1, {.centre = {0, nan}}),
            "threat 1.centre[1] is nan, expected a number from -4096 to 4096");
  EXPECT_EQ(faultOf(1, {.radius = -1}), "threat 1.radius is -1, expected a number from 0 to 4096");
  EXPECT_TRUE(crowd.threats().empty());
  Scene scene = northward(1);
  scene.events = {{1, ThreatChange{.number = 64}}};
  EXPECT_NE(inputFault([&] {
              Crowd(device(), flatGround(), scene);
            }).find("events[0].threat.number is 64, expected less than 64"),
            std::string::npos);
}

// Threats that come and move, and those of a herd, in lock step.
TEST_P(ThreatsReplayTest, TheReferenceFollowsThem) {
  const Heightfield ground = smallRollingGround();
  Crowd crowd(device(), ground, hunted(2));
  for (int part = 0; part < 4; ++part) {
    if (part > 0) crowd.setThreat(0, {.centre = {part - 2.0f, -7}, .radius = 2});
    simulate(device(), crowd, 1);
    // No look at the hunters falls among these.
    expectAllPass(replay(device(), crowd, ground, 13));
    simulate(device(), crowd, 1);
  }
}

INSTANTIATE_TEST_SUITE_P(, ThreatsReplayTest, bothLoadPaths(), loadPathName);

}  // namespace
}  // namespace skitter::test

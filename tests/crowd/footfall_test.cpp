// Touchdowns as events, held against the states that a host downloads.
#include <algorithm>
#include <cmath>
#include <map>

#include "crowd/simulation.h"
#include "skitter/records.h"

namespace skitter::test {
namespace {

using FootfallTest = GpuLoadTest;

glm::dvec3 tipOf(const Rig& rig, const HerdState& state, size_t agent, size_t leg) {
  const auto legs = static_cast<size_t>(rig.legCount());
  const float* t = &state.tip[4 * (agent * legs + leg)];
  return positionOf(state, agent) + glm::dvec3(t[0], t[1], t[2]);
}

TEST_P(FootfallTest, AreTheTouchdownsOfTheStates) {
  const Heightfield ground = rollingGround();
  // Pages of 10, and room for every leg.
  Crowd crowd(device(), ground, sceneOf(24), CrowdOptions{.footfalls = UINT32_MAX, .pageAgents = 10});
  const Rig& rig = crowd.rig(0);
  const auto legs = static_cast<size_t>(rig.legCount());
  HerdState before = crowd.download(0);
  size_t events = 0;
  for (uint64_t tick = 1; tick <= 100; ++tick) {
    simulate(device(), crowd, 1);
    const HerdState after = crowd.download(0);
    std::vector<Footfall> found = crowd.footfalls(0);
    size_t next = 0;
    for (size_t record = 0; record < 24 * legs; ++record) {
      if (!plantedOf(after, record) || plantedOf(before, record)) continue;
      ASSERT_LT(next, found.size()) << "tick " << tick;
      const Footfall& f = found[next++];
      const size_t agent = record / legs, leg = record % legs;
      ASSERT_EQ(f.agent, agent);
      ASSERT_EQ(f.leg, leg);
      EXPECT_EQ(f.tick, tick);
      EXPECT_NEAR(f.seconds, static_cast<double>(tick) / 60, 1e-6);
      // A world coordinate below 128 m is rounded to 4e-6 m, a tip added to its body to 2e-6 m.
      const glm::dvec3 tip = tipOf(rig, after, agent, leg);
      EXPECT_LT(glm::length(glm::dvec3(f.place) - tip), 3e-5);
      EXPECT_NEAR(f.place.y, ground.at(f.place.x, f.place.z), 1e-2);
      const double speed = glm::length(tip - tipOf(rig, before, agent, leg)) * 60;
      EXPECT_NEAR(f.speed, speed, 3e-5 * 60);
      ++events;
    }
    ASSERT_EQ(next, found.size()) << "tick " << tick;
    before = after;
  }
  EXPECT_GT(events, 24 * legs);
  EXPECT_EQ(crowd.droppedFootfalls(0), 0u);
  ASSERT_EQ(crowd.footfallBuffers(0).size(), 3u);
  EXPECT_EQ(crowd.footfallBuffers(0)[2].room, 4 * legs);
}

TEST_P(FootfallTest, WhatHasNoRoomIsCounted) {
  Crowd whole(device(), rollingGround(), sceneOf(40), CrowdOptions{.footfalls = UINT32_MAX});
  Crowd small(device(), rollingGround(), sceneOf(40), CrowdOptions{.footfalls = 2});
  size_t all = 0, kept = 0;
  for (int i = 0; i < 60; ++i) {
    simulate(device(), whole, 1);
    simulate(device(), small, 1);
    all += whole.footfalls(0).size();
    kept += small.footfalls(0).size();
    EXPECT_LE(small.footfalls(0).size(), 2u);
  }
  EXPECT_GT(small.droppedFootfalls(0), 0u);
  EXPECT_EQ(kept + small.droppedFootfalls(0), all);
  EXPECT_EQ(whole.stateHash(), small.stateHash());
}

TEST_P(FootfallTest, NoneUnlessAskedFor) {
  Crowd crowd(device(), rollingGround(), sceneOf(8));
  simulate(device(), crowd, 60);
  EXPECT_TRUE(crowd.footfalls(0).empty());
  EXPECT_EQ(crowd.footfallBuffers(0)[0].room, 0u);
}

INSTANTIATE_TEST_SUITE_P(, FootfallTest, bothLoadPaths(), loadPathName);

}  // namespace
}  // namespace skitter::test

// Agents that keep clear of each other (docs/stages/avoid.md).
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "crowd/grid.h"
#include "crowd/page.h"
#include "crowd/radius.h"
#include "crowd/simulation.h"
#include "crowd/walls.h"
#include "shared/walls.h"
#include "skitter/state.h"
#include "support/rounding.h"

namespace skitter::test {
namespace {

using AvoidTest = GpuTest;
using AvoidReplayTest = GpuLoadTest;
class AvoidControllersTest : public GpuTest, public ::testing::WithParamInterface<Controller> {};

constexpr float kHalfTurn = 3.14159265f;
constexpr int kRound = 4;  // ticks in which everybody looks around once

// Two squares of agents that walk through each other.
Scene meetingScene(uint32_t agents, Controller controller = Controller::adaptive, float spacing = 1.3f) {
  Scene scene = sceneOf(agents - agents / 2, 1, 3, controller);
  scene.herds.push_back(scene.herds[0]);
  scene.herds[1].agents = agents / 2;
  for (const float side : {-1.0f, 1.0f}) {
    Herd& herd = scene.herds[side < 0 ? 0 : 1];
    herd.avoid = true;
    const float depth = std::sqrt(static_cast<float>(std::max(herd.agents, 1u))) * spacing;
    herd.spawn = {.kind = Spawn::Kind::grid,
                  .spacing = spacing,
                  .centre = {0, side * (0.5f * depth + 1)},
                  .heading = side < 0 ? 0.0f : kHalfTurn};
    herd.goal = {.kind = Goal::Kind::velocity, .velocity = {0, -side}};
  }
  return scene;
}

// Agents in pairs, face to face, 8 m apart.
Scene pairsScene(uint32_t pairs, bool avoid) {
  Scene scene = meetingScene(2 * pairs);
  for (Herd& herd : scene.herds) herd.avoid = avoid;
  return scene;
}
void placePairs(Crowd& crowd, uint32_t pairs) {
  std::vector<AgentPlace> places;
  for (uint32_t i = 0; i < pairs; ++i) {
    const float x = 6 * static_cast<float>(i) - 3 * static_cast<float>(pairs);
    places.push_back({crowd.agentId(0, i), {{x, -4}, 0}});
    places.push_back({crowd.agentId(1, i), {{x, 4}, kHalfTurn}});
  }
  crowd.teleport(places);
}

void gather(Crowd& crowd, uint32_t herd, const glm::vec2& at) {
  std::vector<AgentPlace> places;
  for (uint32_t i = 0; i < crowd.places(herd); ++i)
    places.push_back({crowd.agentId(herd, i), {at, 0.1f * static_cast<float>(i)}});
  crowd.teleport(places);
}

double apart(const glm::dvec3& a, const glm::dvec3& b) { return std::hypot(a.x - b.x, a.z - b.z); }

void expectEachPasses(const std::vector<std::vector<validation::StageResult>>& all) {
  for (const auto& results : all) {
    expectAllPass(results);
    for (const validation::StageResult& stage : results) EXPECT_GT(stage.samples, 0u) << stage.name;
  }
}

TEST_P(AvoidReplayTest, FewAndMany) {
  const Heightfield ground = smallRollingGround();
  for (const uint32_t agents : {1u, 2u, 37u}) {
    Crowd crowd(device(), ground, meetingScene(agents));
    simulate(device(), crowd, 60);
    expectAllPass(replayAll(device(), crowd, ground, 60).front());
  }
  Crowd many(device(), rollingGround(), meetingScene(1000));
  simulate(device(), many, 60);
  expectEachPasses(replayAll(device(), many, rollingGround(), 2));
}

// Both have forms of foothold of their own.
TEST_P(AvoidReplayTest, WhoCanBeHurtAndWhoReacts) {
  const Heightfield ground = smallRollingGround();
  for (const bool reacts : {false, true}) {
    Scene scene = meetingScene(24, Controller::adaptive, 0.8f);
    for (Herd& herd : scene.herds) (reacts ? herd.reactions : herd.hurt) = true;
    Crowd crowd(device(), ground, scene);
    crowd.hurt(crowd.agentId(0, 3), 1);
    simulate(device(), crowd, 100);
    expectAllPass(replayAll(device(), crowd, ground, 60).front());
  }
}
INSTANTIATE_TEST_SUITE_P(, AvoidReplayTest, bothLoadPaths(), loadPathName);

TEST_F(AvoidTest, NobodyIsNoCase) {
  Scene scene = meetingScene(2);
  for (Herd& herd : scene.herds) herd.agents = 0;
  Crowd crowd(device(), flatGround(), scene);
  simulate(device(), crowd, 3);
  EXPECT_EQ(crowd.crowding().droppedNeighbours, 0u);
  EXPECT_FALSE(crowd.crowding().overlapMost);
}

// Four in one place, one at a touch of these, and one beyond.
TEST_F(AvoidTest, OverlapsAreMeasured) {
  Scene scene = meetingScene(6);
  for (Herd& herd : scene.herds) {
    herd.avoid = false;
    herd.goal = {.kind = Goal::Kind::none};
  }
  for (const uint32_t pageAgents : {0u, 2u}) {
    Crowd crowd(device(), flatGround(), scene, {.crowding = true, .pageAgents = pageAgents});
    const float radius = crowd::footprintRadius(crowd.rig(0));
    for (uint32_t i = 0; i < 6; ++i)
      crowd.teleport(crowd.agentId(i % 2, i / 2), {{i < 4 ? 0 : i == 4 ? radius : 3.1f * radius, 0}, 0});
    simulate(device(), crowd, 10);
    const Crowding crowding = crowd.crowding();
    EXPECT_FALSE(crowding.droppedNeighbours);
    // 6 pairs by 1 and 4 by a half, of 6 agents who stand. Places and radii are whole quanta.
    EXPECT_NEAR(crowding.overlapMost.value(), 1, 1e-4);
    EXPECT_NEAR(crowding.overlapMean.value(), 8.0 / 6, 4e-3);
    EXPECT_NEAR(crowding.pairs.value(), 10.0 / 6, 1e-12);
  }
}

TEST_P(AvoidControllersTest, IsReplayed) {
  const Heightfield ground = smallRollingGround();
  Crowd crowd(device(), ground, meetingScene(24, GetParam()), {.pageAgents = 7});
  expectEachPasses(replayAll(device(), crowd, ground, 150));
}
INSTANTIATE_TEST_SUITE_P(, AvoidControllersTest, ::testing::ValuesIn(allControllers),
                         [](const auto& param) { return testNameOf(param.param); });

// Large ones, small ones, and a herd that walks on.
TEST_F(AvoidTest, SizesAndHerdsShareTheGround) {
  const Heightfield ground = smallRollingGround();
  Scene scene = meetingScene(20);
  scene.herds[0].sizes = {2, 0.5f};
  scene.herds.push_back(scene.herds[1]);
  scene.herds[2].avoid = false;
  scene.herds[2].spawn.centre = {2, 9};
  Crowd crowd(device(), ground, scene);
  simulate(device(), crowd, 60);
  for (const auto& results : replayAll(device(), crowd, ground, 90)) expectAllPass(results);
  const HerdState avoids = crowd.download(1), walksOn = crowd.download(2);
  EXPECT_EQ(avoids.avoid.size(), 4u * avoids.agents);
  EXPECT_TRUE(walksOn.avoid.empty());
}

TEST_F(AvoidTest, InLongTicks) {
  const Heightfield ground = smallRollingGround();
  Crowd crowd(device(), ground, meetingScene(24));
  expectEachPasses(replayAll(device(), crowd, ground, 40, 2.0f / 15));
}

TEST_F(AvoidTest, InOnePlaceTheyPart) {
  const Heightfield ground = flatGround();
  Scene scene = meetingScene(40);
  scene.herds[0].goal = scene.herds[1].goal = {.kind = Goal::Kind::none};
  Crowd crowd(device(), ground, scene);
  for (const uint32_t herd : {0u, 1u}) gather(crowd, herd, {1, 2});
  simulate(device(), crowd, kRound);
  // Each of 40 sees 39, and keeps clear of 8.
  EXPECT_EQ(crowd.crowding().droppedNeighbours, 40u * 31);
  expectEachPasses(replayAll(device(), crowd, ground, 30));
  simulate(device(), crowd, 600);
  const HerdState a = crowd.download(0), b = crowd.download(1);
  const double radius = crowd::footprintRadius(crowd.rig(0));
  double together = 0;
  for (size_t i = 0; i < 20; ++i)
    for (size_t j = 0; j < 20; ++j) together += apart(positionOf(a, i), positionOf(b, j)) < radius ? 1 : 0;
  EXPECT_LT(together, 40) << "of 400 pairs";
}

// Each of a lattice that lacks every fourth place has two others at 1 m, four at the root of 2 and four at 2
// m: numbers say which of these are the seventh and the eighth. Places and distances are whole quanta.
TEST_F(AvoidTest, NumbersChooseAmongTheEquallyNear) {
  const Heightfield ground = flatGround();
  std::vector<glm::vec2> lattice;
  for (int x = -12; x <= 12; ++x)
    for (int z = -12; z <= 12; ++z)
      if (x % 2 != 0 || z % 2 != 0) lattice.push_back(glm::vec2(x, z));
  std::mt19937 random(3);
  for (size_t i = lattice.size() - 1; i > 0; --i) std::swap(lattice[i], lattice[random() % (i + 1)]);
  const auto agents = static_cast<uint32_t>(lattice.size());
  Scene scene = sceneOf(agents, 1, 3);
  scene.herds[0].avoid = true;
  Crowd crowd(device(), ground, scene);
  std::vector<AgentPlace> places;
  for (uint32_t i = 0; i < agents; ++i)
    places.push_back({crowd.agentId(0, i), {lattice[i], 0.37f * static_cast<float>(i)}});
  crowd.teleport(places);
  expectAllPass(replayAll(device(), crowd, ground, 1).front());
}

TEST_F(AvoidTest, HeadOnPairsPass) {
  constexpr uint32_t pairs = 6;
  const Heightfield ground = flatGround();
  for (const bool avoid : {true, false}) {
    Crowd crowd(device(), ground, pairsScene(pairs, avoid));
    placePairs(crowd, pairs);
    const double touch = 2 * crowd::footprintRadius(crowd.rig(0));
    std::vector<double> nearest(pairs, 1e9);
    for (int tick = 0; tick < 780; tick += 5) {
      simulate(device(), crowd, 5);
      const HerdState a = crowd.download(0), b = crowd.download(1);
      for (uint32_t i = 0; i < pairs; ++i)
        nearest[i] = std::min(nearest[i], apart(positionOf(a, i), positionOf(b, i)));
    }
    const HerdState a = crowd.download(0), b = crowd.download(1);
    for (uint32_t i = 0; i < pairs; ++i) {
      EXPECT_GT(positionOf(a, i).z, 3) << i;
      EXPECT_LT(positionOf(b, i).z, -3) << i;
      if (avoid) {
        EXPECT_GT(nearest[i], 0.8 * touch) << i;
      } else {
        EXPECT_LT(nearest[i], 0.3 * touch) << i;
      }
    }
  }
}

// Agents walk at a wall and at a post, pushed by those behind them.
Scene pressedScene(uint32_t agents) {
  Scene scene = sceneOf(agents, 1, 3);
  scene.obstacles = {{Capsule{.from = {-12, 4}, .to = {12, 4}, .radius = 0.2f}},
                     {ConvexPolygon{.corners = {{-1, 0}, {1, 0}, {1, 1}, {-1, 1}}}},
                     {Disc{.centre = {4, 1}, .radius = 0.5f}}};
  scene.herds[0].avoid = true;
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 1.5f, .centre = {0, -6}};
  scene.herds[0].goal = {.kind = Goal::Kind::velocity, .velocity = {0, 1}};
  return scene;
}

// At most 2 % of agents and ticks: a pair is two agents.
TEST_F(AvoidTest, BodiesHardlyOverlap) {
  Scene pressed = pressedScene(60), sizes = meetingScene(60);
  sizes.herds[0].sizes = {0.7f, 1, 1.4f};
  for (const Scene& scene : {meetingScene(60), sizes, pressed}) {
    Crowd crowd(device(), flatGround(), scene, {.crowding = true});
    simulate(device(), crowd, 600);
    EXPECT_LE(crowd.crowding().overlapMost.value(), 0.02);
    EXPECT_LE(crowd.crowding().pairs.value(), 0.01);
  }
}

// At half, a quarter and an eighth of the rate, far from a camera.
TEST_F(AvoidTest, BodiesHardlyOverlapAtSlowRates) {
  for (const std::array<float, 3> distances : {std::array{0.0f, 8e3f, 8e3f}, {0, 0, 8e3f}, {0, 0, 0}})
    for (const Scene& scene : {meetingScene(60), pressedScene(60)}) {
      CrowdOptions options{.crowding = true};
      options.levels = Levels{.distances = distances, .most = {0, 60, 60}};
      Crowd crowd(device(), flatGround(), scene, options);
      crowd.lookFrom({0, 500, 0});
      simulate(device(), crowd, 300);
      EXPECT_LE(crowd.crowding().overlapMost.value(), 0.02);
      EXPECT_LE(crowd.crowding().pairs.value(), 0.01);
    }
}

TEST_F(AvoidTest, WhatIsBesideDoesNotShow) {
  const Heightfield ground = smallRollingGround();
  const auto hashWith = [&](const CrowdOptions& options) {
    Crowd crowd(device(), ground, meetingScene(61), options);
    simulate(device(), crowd, 150);
    return crowd.stateHash();
  };
  for (const bool sleep : {false, true}) {
    const uint64_t hash = hashWith({.sleep = sleep});
    EXPECT_EQ(hash, hashWith({.sleep = sleep}));
    EXPECT_EQ(hash, hashWith({.sleep = sleep, .pageAgents = 7}));
    if (kernelsRoundAlike(device())) {
      EXPECT_EQ(hash, hashWith({.sleep = sleep, .fuse = false}));
    }
    EXPECT_EQ(hash, hashWith({.pose = false, .measure = false, .sleep = sleep, .timestamps = true}));
  }
}

// Bit for bit, whenever it looks around.
TEST_F(AvoidTest, ALoneAgentGoesWhereItWantsTo) {
  Scene alone = sceneOf(1);
  alone.herds[0].avoid = true;
  Crowd crowd(device(), rollingGround(), alone);
  for (int i = 0; i < 30; ++i) {
    simulate(device(), crowd, kRound);
    const HerdState state = crowd.download(0);
    EXPECT_GT(std::hypot(state.steer[0], state.steer[1]), 0.1f);
    for (const size_t axis : {0u, 1u})
      EXPECT_EQ(state.avoid[axis], state.steer[axis]) << "tick " << state.tick;
  }
}

// In a tick a quarter of the blocks decide anew, and all of them in a round.
TEST_F(AvoidTest, EverybodyLooksAroundOnceInARound) {
  Scene scene = sceneOf(100);
  scene.herds[0].avoid = true;
  Crowd crowd(device(), smallRollingGround(), scene, {.pageAgents = 28});
  simulate(device(), crowd, 30);
  HerdState before = crowd.download(0);
  std::vector<int> looks(100);
  for (int i = 0; i < kRound; ++i) {
    simulate(device(), crowd, 1);
    HerdState after = crowd.download(0);
    for (size_t agent = 0; agent < 100; ++agent) {
      const bool isNew =
          !std::equal(&after.avoid[4 * agent], &after.avoid[4 * agent + 4], &before.avoid[4 * agent]);
      if (!isNew) continue;
      EXPECT_EQ((agent / 8 + after.tick) % kRound, 0u) << agent;
      ++looks[agent];
    }
    before = std::move(after);
  }
  // Some decide as they did.
  EXPECT_THAT(looks, ::testing::Each(::testing::Le(1)));
  EXPECT_GT(std::ranges::count(looks, 1), 80);
}

TEST_F(AvoidTest, WhoDoesNotAskPaysNothing) {
  const Heightfield ground = flatGround();
  Scene scene = meetingScene(40);
  scene.herds[0].avoid = scene.herds[1].avoid = false;
  const Crowd off(device(), ground, scene);
  EXPECT_EQ(implOf(off).grid, nullptr);
  for (const crowd::Kind& kind : implOf(off).kinds) {
    for (const crowd::Page& page : kind.pages) EXPECT_FALSE(page.avoid);
    for (const crowd::ReadyStage& stage : kind.stages) EXPECT_FALSE(stage.makes.has(crowd::StageId::avoid));
  }
  scene.herds[1].avoid = true;
  const Crowd one(device(), ground, scene);
  EXPECT_NE(implOf(one).grid, nullptr);
  const auto bytesOf = [](const Crowd& crowd, uint32_t herd) {
    uint64_t bytes = 0;
    for (const MemoryUse& use : crowd.memoryUse(herd)) bytes += use.name == "avoid" ? use.bytes : 0;
    return bytes;
  };
  EXPECT_EQ(bytesOf(one, 0), 0u);
  EXPECT_EQ(bytesOf(one, 1), 20u * 16);
}

TEST_F(AvoidTest, SleepersWakeForWhoComes) {
  const Heightfield ground = flatGround();
  Scene scene = meetingScene(2);
  scene.herds[0].goal = {.kind = Goal::Kind::none};
  scene.herds[1].goal = {.kind = Goal::Kind::none};
  // It goes straight on, so that the sleeper is in its way.
  scene.herds[1].avoid = false;
  Crowd crowd(device(), ground, scene, {.sleep = true});
  const auto place = [&](uint32_t herd, float z, float heading) {
    crowd.teleport(crowd.agentId(herd, 0), {{0, z}, heading});
  };
  place(0, 0, 0);
  place(1, 14, kHalfTurn);
  simulate(device(), crowd, 600);
  EXPECT_EQ(crowd.sleeping(), 2u);
  crowd.steer(1, Goal{.kind = Goal::Kind::velocity, .velocity = {0, -1}});
  bool woke = false;
  for (int tick = 0; tick < 900 && !woke; tick += 10) {
    simulate(device(), crowd, 10);
    woke = crowd.sleeping() == 0;
  }
  EXPECT_TRUE(woke);
  for (const auto& results : replayAll(device(), crowd, ground, 60)) expectAllPass(results);
}

TEST_F(AvoidTest, NobodyIsSeenInAnEmptyPlace) {
  const Heightfield ground = flatGround();
  Scene scene = meetingScene(10);
  for (Herd& herd : scene.herds) {
    herd.reserve = 3;
    herd.goal = {.kind = Goal::Kind::none};
  }
  Crowd crowd(device(), ground, scene);
  for (const uint32_t herd : {0u, 1u})
    for (uint32_t agent = 0; agent < 5; ++agent) crowd.teleport(crowd.agentId(herd, agent), {{1, 1}, 0});
  simulate(device(), crowd, kRound);
  EXPECT_EQ(crowd.download(0).avoid[2], -9);
  crowd.remove(crowd.agentId(0, 4));
  crowd.remove(crowd.agentId(1, 0));
  simulate(device(), crowd, kRound);
  EXPECT_EQ(crowd.download(0).avoid[2], -7);
  EXPECT_EQ(crowd.download(1).avoid[2], 1) << "an empty place sleeps";
  crowd.add(1, {{1, 1}, 0});
  simulate(device(), crowd, kRound);
  EXPECT_EQ(crowd.download(0).avoid[2], -8);
  for (const auto& results : replayAll(device(), crowd, ground, 30)) expectAllPass(results);
}

TEST_F(AvoidTest, HerdsThatComeShareTheGround) {
  const Heightfield ground = flatGround();
  Scene scene = meetingScene(30);
  const Herd late = scene.herds[1];
  scene.herds.pop_back();
  scene.herds[0].avoid = false;
  Crowd crowd(device(), ground, scene);
  simulate(device(), crowd, 5);
  EXPECT_EQ(implOf(crowd).grid, nullptr);
  const HerdId id = crowd.addHerd(late);
  ASSERT_NE(implOf(crowd).grid, nullptr);
  for (const auto& results : replayAll(device(), crowd, ground, 60)) expectAllPass(results);
  Herd large = late;
  large.sizes = {3};
  large.spawn.centre = {6, 3};
  crowd.addHerd(large);
  for (const auto& results : replayAll(device(), crowd, ground, 30)) expectAllPass(results);
  crowd.removeHerd(id);
  simulate(device(), crowd, 5);
  EXPECT_NE(implOf(crowd).grid, nullptr);
  crowd.removeHerd(crowd.herdId(2));
  EXPECT_EQ(implOf(crowd).grid, nullptr);
  simulate(device(), crowd, 5);
}

TEST_F(AvoidTest, AStateGoesOnAsTheCrowdDoes) {
  const Heightfield ground = smallRollingGround();
  Crowd crowd(device(), ground, meetingScene(40), {.sleep = true});
  simulate(device(), crowd, 70);
  Crowd again(device(), parseState(crowd.saveToMemory(), "a state"));
  for (Crowd* each : {&crowd, &again}) simulate(device(), *each, 70);
  EXPECT_EQ(crowd.stateHash(), again.stateHash());
  EXPECT_EQ(crowd.download(0).avoid, again.download(0).avoid);
}

// Far from the middle, across tiles and buckets.
TEST_F(AvoidTest, TheGridHasNoEdges) {
  const Heightfield ground =
      generateHeightfield({.columns = 1025, .rows = 1025, .spacing = 7.9f, .amplitude = 2});
  Scene scene = meetingScene(24);
  Crowd crowd(device(), ground, scene);
  std::vector<AgentPlace> places;
  for (uint32_t i = 0; i < 12; ++i) {
    // Four to a corner of the terrain and at the middle, on both sides of a tile's edge.
    const float at = i < 4 ? -4000 : i < 8 ? 0 : 4000;
    const float x = at + 0.7f * static_cast<float>(i % 4) - 1;
    places.push_back({crowd.agentId(0, i), {{x, at - 1}, 0}});
    places.push_back({crowd.agentId(1, i), {{x, at + 1}, kHalfTurn}});
  }
  crowd.teleport(places);
  const auto results = replayAll(device(), crowd, ground, 60);
  for (const auto& each : results) expectAllPass(each);
  const HerdState state = crowd.download(0);
  for (uint32_t i = 0; i < 12; ++i) EXPECT_LE(state.avoid[4 * i + 2], -3) << i;
}

// How far a place is from the nearest of these obstacles.
double fromObstacles(const glm::dvec3& at) {
  const double wall = std::hypot(std::max(std::abs(at.x) - 12, 0.0), at.z - 4) - 0.2;
  const double post =
      std::hypot(std::max(std::abs(at.x) - 1, 0.0), std::max(std::abs(at.z - 0.5) - 0.5, 0.0));
  return std::min({wall, post, std::hypot(at.x - 4, at.z - 1) - 0.5});
}

TEST_F(AvoidTest, ObstaclesAreKeptClearOf) {
  Crowd crowd(device(), flatGround(), pressedScene(36));
  const double radius = crowd::footprintRadius(crowd.rig(0));
  double nearest = 1e9;
  for (int part = 0; part < 120; ++part) {
    simulate(device(), crowd, 10);
    const HerdState state = crowd.download(0);
    for (uint32_t i = 0; i < state.agents; ++i)
      nearest = std::min(nearest, fromObstacles(positionOf(state, i)));
  }
  // They come close. The one whom most others press comes to 0.995 of its radius (docs/stages/avoid.md).
  EXPECT_LT(nearest, 1.1 * radius);
  EXPECT_GT(nearest, 0.95 * radius);
}

TEST_P(AvoidReplayTest, AmongObstacles) {
  const Heightfield ground = smallRollingGround();
  Crowd crowd(device(), ground, pressedScene(25), {.pageAgents = 7});
  simulate(device(), crowd, 200);
  expectAllPass(replayAll(device(), crowd, ground, 120).front());
}

TEST_F(AvoidTest, AmongObstaclesWhatIsBesideDoesNotShow) {
  const auto hashWith = [&](const CrowdOptions& options) {
    Crowd crowd(device(), smallRollingGround(), pressedScene(30), options);
    simulate(device(), crowd, 200);
    return crowd.stateHash();
  };
  const uint64_t hash = hashWith({});
  EXPECT_EQ(hash, hashWith({}));
  EXPECT_EQ(hash, hashWith({.pageAgents = 7}));
  if (kernelsRoundAlike(device())) {
    EXPECT_EQ(hash, hashWith({.fuse = false}));
  }
}

// Far from all of them, and where there are none.
TEST_F(AvoidTest, ObstaclesThatAreFarDoNotShow) {
  Scene far = meetingScene(30), none = far;
  far.obstacles = {{Disc{.centre = {-30, -30}, .radius = 0.5f}}};
  Crowd a(device(), flatGround(), far), b(device(), flatGround(), none);
  for (Crowd* crowd : {&a, &b}) simulate(device(), *crowd, 60);
  EXPECT_EQ(a.stateHash(), b.stateHash());
  EXPECT_TRUE(implOf(a).kinds[0].wallBuffer);
  EXPECT_FALSE(implOf(b).kinds[0].wallBuffer);
}

// The obstacles that the records have for a place, as numbers of edges.
std::vector<glm::vec2> edgeStartsAt(const std::vector<float>& records, const glm::vec2& place) {
  const auto vec4 = [&](float at) { return &records[4 * static_cast<size_t>(at)]; };
  const glm::vec2 cell = glm::floor((place - glm::vec2(vec4(1)[0], vec4(1)[1])) * vec4(0)[2]);
  const float* runs = vec4(static_cast<float>(shared::WALL_HEADS) + cell.y * vec4(0)[0] + cell.x);
  std::vector<glm::vec2> starts;
  for (float i = 0; i < runs[1]; ++i) {
    const float* edge = vec4(runs[0] + i * static_cast<float>(shared::WALL_EDGE_STRIDE));
    starts.emplace_back(edge[0], edge[1]);
  }
  return starts;
}

TEST(WallRecords, HaveWhatIsInReach) {
  const Heightfield ground = flatGround();
  std::vector<Obstacle> discs;
  for (uint32_t i = 0; i < 200; ++i) {
    const auto along = [&](uint32_t k) {
      return 50 * std::fmod(static_cast<float>(i * k), 1.618f) / 1.618f - 25;
    };
    discs.push_back({Disc{.centre = {along(7), along(13)}, .radius = 0.1f * static_cast<float>(1 + i % 20)}});
  }
  for (const uint64_t most : {uint64_t{1} << 20, uint64_t{2000}}) {
    const auto records = crowd::wallRecords(ground, discs, 2.5f, most);
    ASSERT_TRUE(records) << most;
    EXPECT_LE(records->size(), 4 * most);
    size_t found = 0;
    for (float x = -24; x < 24; x += 1.7f)
      for (float z = -24; z < 24; z += 1.9f) {
        const std::vector<glm::vec2> starts = edgeStartsAt(*records, {x, z});
        found += starts.size();
        for (const Obstacle& obstacle : discs) {
          const Disc& disc = std::get<Disc>(obstacle.shape);
          if (glm::distance(disc.centre, {x, z}) > disc.radius + 2.5f) continue;
          EXPECT_NE(std::ranges::find(starts, disc.centre), starts.end()) << x << ", " << z;
        }
      }
    if (most > 2000) {
      EXPECT_LT(found, 29 * 26 * discs.size() / 2) << "far from all are in every cell";
    }
  }
  EXPECT_FALSE(crowd::wallRecords(ground, discs, 2.5f, 300));
}

TEST_F(AvoidTest, FootprintsHoldTrunkAndHalfOfTheWayHome) {
  const Rig rig = spiderRig();
  float home = 0;
  for (const Leg& leg : rig.legs) home = std::max(home, std::hypot(leg.home.x, leg.home.z));
  EXPECT_FLOAT_EQ(crowd::footprintRadius(rig), std::max(rig.bodyRadius, home / 2));
  Scene scene = meetingScene(8);
  scene.herds[0].sizes = {20};
  const Crowd large(device(), flatGround(), scene);
  const crowd::Quanta quanta = crowd::quantaOf(implOf(large));
  EXPECT_LE(quanta.longestReach, 32767u);
  EXPECT_LT(quanta.inMetre, 1024);
  EXPECT_EQ(crowd::quantaOf(implOf(Crowd(device(), flatGround(), meetingScene(8)))).inMetre, 1024);
}

}  // namespace
}  // namespace skitter::test

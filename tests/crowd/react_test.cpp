// Herds with reactions: pushes, ground that gives way, falls, and how their agents get up.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "assets/files.h"
#include "crowd/herd.h"
#include "crowd/simulation.h"
#include "shared/parameters.h"
#include "skitter/error.h"
#include "skitter/state.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

using ReactTest = GpuTest;
using ReactInputTest = GpuTest;

Scene reactingScene(uint32_t agents) {
  Scene scene = sceneOf(agents);
  scene.herds[0].reactions = true;
  return scene;
}

// All walk forward, out of each other's way.
Scene abreast(uint32_t agents) {
  Scene scene = reactingScene(agents);
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 2};
  scene.herds[0].goal = {.kind = Goal::Kind::velocity, .velocity = {0, 1}};
  return scene;
}

// Each agent is pushed in a direction of its own.
void pushAllAside(Crowd& crowd, float speed) {
  for (uint32_t agent = 0; agent < crowd.places(0); ++agent) {
    const float angle = 0.7f * static_cast<float>(agent);
    crowd.push(crowd.agentId(0, agent), speed * glm::vec2(std::cos(angle), std::sin(angle)));
  }
}

uint32_t fallenIn(const std::vector<Reaction>& all) {
  return static_cast<uint32_t>(
      std::ranges::count_if(all, [](const Reaction& each) { return each.falls > 0; }));
}

// No number that is none, no hull below the ground, no fallen foot that stands.
void expectSound(const Crowd& crowd, const HerdState& state) {
  const crowd::Kind& kind = implOf(crowd).kinds[0];
  const size_t legs = static_cast<size_t>(kind.legs);
  for (const Record record : {Record::body, Record::reaction, Record::step, Record::chain, Record::tip})
    for (const float value : state.of(record)) ASSERT_TRUE(std::isfinite(value));
  for (size_t agent = 0; agent < state.agents; ++agent) {
    const reference::AgentBody body = validation::bodyOf(state, agent);
    const reference::Reaction reaction = validation::reactionOf(state, agent);
    for (int k = -1; k <= 1; ++k) {
      const glm::dvec3 hull =
          body.orientation * glm::dvec3(0, kind.rig.bodyHeight, k * double{kind.rig.bodyRadius});
      const glm::dvec2 at = body.world() + glm::dvec2(hull.x, hull.z);
      const double ground = crowd.terrain().at(static_cast<float>(at.x), static_cast<float>(at.y));
      EXPECT_GT(body.y + hull.y, ground) << "agent " << agent;
    }
    for (size_t leg = agent * legs; reaction.isFallen() && leg < (agent + 1) * legs; ++leg)
      EXPECT_FALSE(plantedOf(state, leg)) << "agent " << agent;
  }
}

TEST_F(ReactTest, HarderPushesFellMore) {
  constexpr uint32_t agents = 64;
  std::map<float, double> curve;
  for (const float speed : {0.5f, 2.0f, 4.0f, 6.0f, 12.0f}) {
    Crowd crowd(device(), flatGround(), abreast(agents), kAllWatched);
    simulate(device(), crowd, 90);
    pushAllAside(crowd, speed);
    for (int i = 0; i < 30; ++i) {
      simulate(device(), crowd, 10);
      expectSound(crowd, crowd.download(0));
    }
    const std::vector<Reaction> all = crowd.reactions(0);
    curve[speed] = fallenIn(all) / double{agents};
    for (const Reaction& each : all) {
      EXPECT_EQ(each.stands, each.falls) << "who fell stands again within 5 s, at " << speed << " m/s";
      EXPECT_LE(each.downBefore, 5.0f);
    }
    EXPECT_LT(crowd.fidelity(0).limitViolation.value_or(0), 1e-3);
  }
  double before = 0;
  for (const auto& [speed, share] : curve) {
    EXPECT_GE(share, before) << speed << " m/s";
    before = share;
  }
  EXPECT_EQ(curve[0.5f], 0);
  EXPECT_EQ(curve[12.0f], 1);
}

// The same impulse, of which all who carry nothing fall.
TEST_F(ReactTest, HeavyLoadsKeepFromFallingAndThoseFarOutFell) {
  constexpr uint32_t agents = 32;
  const auto fallen = [&](float speed, const Load& load) {
    Crowd crowd(device(), flatGround(), abreast(agents), kAllWatched);
    for (uint32_t agent = 0; agent < agents; ++agent) crowd.carry(crowd.agentId(0, agent), load);
    simulate(device(), crowd, 90);
    pushAllAside(crowd, speed);
    simulate(device(), crowd, 30);
    return fallenIn(crowd.reactions(0));
  };
  EXPECT_EQ(fallen(12, {}), agents);
  const uint32_t heavy = fallen(12, {.mass = 3});
  EXPECT_LT(heavy, agents / 2);
  EXPECT_GT(fallen(12, {.mass = 3, .offset = {0, 2, 0}}), heavy) << "the pendulum is longer";
  EXPECT_GT(fallen(12, {.mass = 3, .offset = {1, 0, 0}}), heavy) << "the centre is further out";
}

TEST_F(ReactTest, GroundThatIsGoneUnderAFootFellsNobody) {
  constexpr uint32_t agents = 40, legs = 8;
  Scene scene = reactingScene(agents);
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 3};
  Heightfield ground = flatGround();
  Crowd crowd(device(), ground, scene, kAllWatched);
  simulate(device(), crowd, 90);
  const HerdState before = crowd.download(0);
  // The samples around a planted foot of each.
  for (uint32_t agent = 0; agent < agents; ++agent) {
    for (size_t leg = agent * legs; leg < (agent + 1) * legs; ++leg) {
      if (!plantedOf(before, leg)) continue;
      const reference::Step step = validation::stepOf(before, leg);
      const double x = step.tileX * shared::TILE_SIZE + step.landing.x;
      const double z = step.tileZ * shared::TILE_SIZE + step.landing.z;
      const auto column = static_cast<uint32_t>((x - ground.originX()) / ground.spacingX);
      const auto row = static_cast<uint32_t>((z - ground.originZ()) / ground.spacingZ);
      crowd.editHeights(column, row, 2, 2, std::vector<float>(4, -0.4f));
      break;
    }
  }
  simulate(device(), crowd, 1);
  uint32_t disturbed = 0;
  const HerdState now = crowd.download(0);
  for (size_t agent = 0; agent < agents; ++agent)
    disturbed += validation::reactionOf(now, agent).phase == reference::ReactionPhase::stumbling;
  EXPECT_GT(disturbed, agents / 2);
  simulate(device(), crowd, 180);
  expectSound(crowd, crowd.download(0));
  EXPECT_LE(fallenIn(crowd.reactions(0)), agents / 20);
  EXPECT_LT(crowd.fidelity(0).slip, 0.01);
}

TEST_F(ReactTest, FoldedLegsHaveNoTouchdownsAndNoSlip) {
  Crowd crowd(device(), flatGround(), reactingScene(8), kAllWatched);
  simulate(device(), crowd, 60);
  for (uint32_t agent = 0; agent < 8; ++agent) crowd.push(crowd.agentId(0, agent), {15, 0});
  for (int i = 0; i < 200; ++i) {
    simulate(device(), crowd, 1);
    const std::vector<Reaction> all = crowd.reactions(0);
    for (const Footfall& footfall : crowd.footfalls(0)) {
      const ReactionPhase phase = all[footfall.agent].phase;
      EXPECT_FALSE(phase >= ReactionPhase::falling && phase <= ReactionPhase::righting);
    }
  }
  EXPECT_EQ(fallenIn(crowd.reactions(0)), 8u);
}

TEST_F(ReactTest, OthersHaveNeitherRecordsNorOtherBits) {
  const Heightfield ground = rollingGround();
  Scene scene = reactingScene(10);
  scene.herds.push_back(scene.herds[0]);
  scene.herds[1].reactions = false;
  Scene alone = scene;
  alone.herds[0].reactions = false;
  Crowd crowd(device(), ground, scene, kAllWatched), plain(device(), ground, alone, kAllWatched);
  for (Crowd* each : {&crowd, &plain}) simulate(device(), *each, 20);
  crowd.push(crowd.agentId(0, 3), {4, 4});
  for (Crowd* each : {&crowd, &plain}) simulate(device(), *each, 40);
  EXPECT_TRUE(crowd.buffers(1, Record::reaction).empty());
  EXPECT_TRUE(crowd.buffers(1, Record::push).empty());
  const HerdState ours = crowd.download(1), theirs = plain.download(1);
  for (const Record record : allRecords) {
    if (record == Record::watch) continue;
    EXPECT_TRUE(sameBits(ours.of(record), theirs.of(record))) << static_cast<int>(record);
  }
  for (const Reaction& each : crowd.reactions(1)) EXPECT_EQ(each.phase, ReactionPhase::steady);
}

TEST_F(ReactTest, AStateHasFallsAndWhatWaits) {
  Scene scene = reactingScene(12);
  Crowd crowd(device(), rollingGround(), scene, kAllWatched);
  simulate(device(), crowd, 30);
  for (uint32_t agent = 0; agent < 12; agent += 2) crowd.push(crowd.agentId(0, agent), {13, 0});
  simulate(device(), crowd, 40);
  crowd.push(crowd.agentId(0, 1), {2, 1});  // waits for the next tick
  crowd.push(crowd.agentId(0, 1), {1, 1});
  const State state = parseState(crowd.saveToMemory(), "react.state");
  Crowd again(device(), state);
  for (Crowd* each : {&crowd, &again}) simulate(device(), *each, 60);
  EXPECT_EQ(crowd.stateHash(), again.stateHash());
  EXPECT_GT(fallenIn(again.reactions(0)), 0u);
}

TEST_F(ReactTest, PagesAndFusionDoNotShow) {
  const auto hashOf = [&](const CrowdOptions& options) {
    Crowd crowd(device(), rollingGround(), reactingScene(40), options);
    simulate(device(), crowd, 10);
    for (uint32_t agent = 0; agent < 40; agent += 3)
      crowd.push(crowd.agentId(0, agent), {0.5f * static_cast<float>(agent), 1});
    simulate(device(), crowd, 90);
    return crowd.stateHash();
  };
  const uint64_t whole = hashOf({});
  EXPECT_EQ(whole, hashOf({.pageAgents = 7}));
  EXPECT_EQ(whole, hashOf({.fuse = false}));
  EXPECT_EQ(whole, hashOf(kAllWatched));
}

TEST_F(ReactTest, WhoSleepsWakesAndWhoIsTeleportedStands) {
  Scene scene = reactingScene(6);
  scene.herds[0].goal.kind = Goal::Kind::none;
  CrowdOptions options = kAllWatched;
  options.sleep = true;
  Crowd crowd(device(), flatGround(), scene, options);
  simulate(device(), crowd, 300);
  ASSERT_EQ(crowd.sleeping(), 6u);
  crowd.push(crowd.agentId(0, 1), {15, 0});
  simulate(device(), crowd, 30);
  EXPECT_EQ(crowd.sleeping(), 5u);
  EXPECT_EQ(crowd.reactions(0)[1].falls, 1u);
  crowd.teleport(crowd.agentId(0, 1), {{3, 4}, 1});
  simulate(device(), crowd, 1);
  EXPECT_EQ(crowd.reactions(0)[1].phase, ReactionPhase::steady);
  EXPECT_EQ(crowd.reactions(0)[1].falls, 0u);
}

TEST_F(ReactInputTest, NamesWhatIsWrong) {
  Scene scene = reactingScene(5);
  scene.herds.push_back(scene.herds[0]);
  scene.herds[1].reactions = false;
  Crowd crowd(device(), rollingGround(), scene);
  const uint64_t hash = crowd.stateHash();
  EXPECT_EQ(inputFault([&] {
              crowd.push(crowd.agentId(1, 2), {1, 0});
            }),
            "herd 1, agent 2: reactions is false, expected a herd with reactions");
  EXPECT_EQ(inputFault([&] {
              crowd.push(crowd.agentId(0, 2), {101, 0});
            }),
            "herd 0, agent 2: the length of the push is 101 m/s, expected 0 to 100");
  EXPECT_NE(inputFault([&] { crowd.push(crowd.agentId(0, 2), {NAN, 0}); }), "");
  EXPECT_EQ(crowd.stateHash(), hash);
  scene.herds[0].controller = Controller::loop;
  EXPECT_EQ(inputFault([&] { Crowd(device(), rollingGround(), scene); }),
            scene.name + ": herds[0].controller is loop, expected adaptive: it has reactions");
  scene.herds[0].controller = Controller::adaptive;
  scene.events = {{0, Push{.herd = 1, .velocity = {1, 0}}}};
  EXPECT_EQ(inputFault([&] { Crowd(device(), rollingGround(), scene); }),
            scene.name + ": events[0]: herd 1: reactions is false, expected a herd with reactions");
}

// assets/scenes/pushed.json and collapse.json.
TEST_F(ReactTest, ExamplesRun) {
  for (const char* name : {"pushed", "collapse"}) {
    SCOPED_TRACE(name);
    const Scene scene = loadScene(fmt::format("{}/assets/scenes/{}.json", SKITTER_ROOT, name));
    Crowd crowd(device(), scene.loadTerrain(), scene, kAllWatched);
    simulate(device(), crowd, 750);
    expectSound(crowd, crowd.download(0));
    const std::vector<Reaction> all = crowd.reactions(0);
    EXPECT_GT(fallenIn(all), 0u);
    simulate(device(), crowd, 300);
    for (const Reaction& each : crowd.reactions(0)) EXPECT_EQ(each.stands, each.falls);
  }
}

}  // namespace
}  // namespace skitter::test

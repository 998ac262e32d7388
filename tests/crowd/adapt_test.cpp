// Herds that adapt: agents that are not told which legs they lost find a gait by trial and error.
#include <gmock/gmock.h>

#include <algorithm>

#include "assets/files.h"
#include "base/split_mix.h"
#include "crowd/gait_map.h"
#include "crowd/herd.h"
#include "crowd/page.h"
#include "crowd/simulation.h"
#include "gpu/transfer.h"
#include "shared/adapt.h"
#include "skitter/error.h"
#include "skitter/state.h"

namespace skitter::test {
namespace {

using AdaptTest = GpuTest;
using AdaptInputTest = GpuTest;

constexpr float longTick = 1.0f / 15;
constexpr int ticksOfTrial = 252;  // of 1/60 s

// 512 m a side: nobody comes to its edge.
Heightfield widePlain() {
  Heightfield plain;
  plain.columns = plain.rows = 33;
  plain.spacingX = plain.spacingZ = 16;
  plain.heights.assign(size_t{plain.columns} * plain.rows, 0);
  return plain;
}

// All walk forward, out of each other's way.
Scene adaptingScene(uint32_t agents) {
  Scene scene = hurtScene(agents);
  scene.herds[0].adapts = true;
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 2};
  scene.herds[0].goal = {.kind = Goal::Kind::velocity, .velocity = {0, 1.2f}};
  return scene;
}

// Each agent loses two legs of its own.
void hurtAll(Crowd& crowd) {
  std::vector<AgentLeg> legs;
  for (uint32_t agent = 0; agent < crowd.agentCount(); ++agent)
    for (const uint32_t leg : {agent % 8, (agent + 1 + agent / 8 % 7) % 8})
      legs.push_back({crowd.agentId(0, agent), leg});
  crowd.hurt(legs);
}

struct Walked {
  double speed, unstable;  // metres per second; share of the ticks
};
// How a herd gets on over so many ticks.
Walked walk(Device& device, Crowd& crowd, int ticks) {
  const auto unstable = [&] {
    const Fidelity f = crowd.fidelity();
    return f.unstable * static_cast<double>(f.agentTicks);
  };
  const auto way = [&] {
    const HerdState state = crowd.download(0);
    double sum = 0;
    for (size_t agent = 0; agent < state.agents; ++agent) sum += positionOf(state, agent).z;
    return sum;
  };
  const double unstableBefore = unstable(), wayBefore = way();
  simulate(device, crowd, ticks);
  const double agentTicks = static_cast<double>(crowd.agentCount()) * ticks;
  return {(way() - wayBefore) / (agentTicks * double{kTick}), (unstable() - unstableBefore) / agentTicks};
}

TEST_F(AdaptTest, AgentsFindAGaitThatHoldsThem) {
  constexpr uint32_t agents = 28;
  Scene scene = adaptingScene(agents);
  Crowd crowd(device(), widePlain(), scene, kAllWatched);
  simulate(device(), crowd, 60);
  for (const Search& each : crowd.searches(0)) EXPECT_EQ(each.phase, SearchPhase::atEase);
  hurtAll(crowd);
  simulate(device(), crowd, 1);
  for (const Search& each : crowd.searches(0)) {
    EXPECT_EQ(each.phase, SearchPhase::searching);
    EXPECT_EQ(each.trials, 0u);
  }
  simulate(device(), crowd, ticksOfTrial * static_cast<int>(shared::SEARCH_MOST_TRIALS));
  std::vector<uint32_t> trials;
  for (const Search& each : crowd.searches(0)) {
    EXPECT_EQ(each.phase, SearchPhase::settled);
    EXPECT_GE(each.best, 0.8f);
    trials.push_back(each.trials);
  }
  std::ranges::sort(trials);
  EXPECT_LE(trials[agents / 2], 8u);
}

// With what it has kept an agent walks as well as one that was told, and better than one in its old gait.
TEST_F(AdaptTest, WhoIsSettledWalksAsWellAsWhoWasTold) {
  const Heightfield ground = widePlain();
  Scene told = adaptingScene(28);
  told.herds[0].adapts = false;
  Crowd searching(device(), ground, adaptingScene(28), kAllWatched),
      informed(device(), ground, told, kAllWatched);
  for (Crowd* crowd : {&searching, &informed}) hurtAll(*crowd);
  const Walked atFirst = walk(device(), searching, 240);  // in the gait of whole ones, which is tried first
  simulate(device(), searching, ticksOfTrial * 12);
  simulate(device(), informed, 240);
  const Walked settled = walk(device(), searching, 1200), best = walk(device(), informed, 1200);
  EXPECT_GT(atFirst.unstable, 0.1);
  EXPECT_LE(settled.unstable, best.unstable + 0.05);
  EXPECT_GE(settled.speed, 0.9 * best.speed);
}

// Makes every agent search anew, with the gait of the pattern that it has lost, which nobody told it.
void tryTheirOwnPatterns(Crowd& crowd, const crowd::Kind& kind) {
  std::vector<uint32_t> patterns = crowd::walkingPatterns(kind.rig);
  patterns.insert(patterns.begin(), 0);
  const gpu::Context& context = *implOf(crowd).context;
  for (const crowd::Page& page : kind.pages) {
    std::vector<float> searches = gpu::download<float>(context, page.search);
    for (size_t at = 0; at < searches.size(); at += 4 * size_t{shared::SEARCH_STRIDE}) {
      const auto idle = static_cast<uint32_t>(searches[at]);
      std::fill_n(searches.begin() + static_cast<ptrdiff_t>(at) + 2, 4 * shared::SEARCH_STRIDE - 2, 0.0f);
      searches[at + 2] = shared::SEARCH_SEARCHES;
      searches[at + 4] = static_cast<float>(std::ranges::find(patterns, idle) - patterns.begin());
    }
    gpu::upload(context, page.search, searches);
  }
}

// One to three legs each, drawn at random. The best gait that is known for a loss is the one of its pattern.
TEST_F(AdaptTest, NearlyAllComeToNineTenthsOfTheBestGaitThatIsKnown) {
  constexpr uint32_t agents = 100;
  Crowd crowd(device(), widePlain(), adaptingScene(agents));
  base::SplitMix64 random(1);
  std::vector<AgentLeg> legs;
  for (uint32_t agent = 0; agent < agents; ++agent)
    for (uint32_t k = 0; k <= agent % 3; ++k)
      legs.push_back({crowd.agentId(0, agent), static_cast<uint32_t>(random() % 8)});
  crowd.hurt(legs);
  simulate(device(), crowd, 1 + ticksOfTrial * shared::SEARCH_MOST_TRIALS);
  const std::vector<Search> found = crowd.searches(0);
  tryTheirOwnPatterns(crowd, implOf(crowd).kindOf(0));
  simulate(device(), crowd, ticksOfTrial + 1);
  const std::vector<Search> known = crowd.searches(0);
  std::vector<uint32_t> trials;
  uint32_t good = 0;
  for (uint32_t agent = 0; agent < agents; ++agent) {
    EXPECT_EQ(found[agent].phase, SearchPhase::settled);
    EXPECT_EQ(known[agent].trials, 1u);
    trials.push_back(found[agent].trials);
    good += found[agent].best >= 0.9f * known[agent].best;
  }
  std::ranges::sort(trials);
  RecordProperty("good", static_cast<int>(good));
  RecordProperty("median", static_cast<int>(trials[agents / 2]));
  RecordProperty("most", static_cast<int>(trials.back()));
  EXPECT_GE(good, 97u);
  EXPECT_LE(trials[agents / 2], 8u);
}

TEST_F(AdaptTest, OthersHaveNeitherRecordsNorOtherBits) {
  const Heightfield ground = rollingGround();
  Scene told = hurtScene(12), both = told;
  both.herds.push_back(both.herds[0]);
  both.herds[1].adapts = true;
  Crowd alone(device(), ground, told, kAllWatched), beside(device(), ground, both, kAllWatched);
  for (Crowd* crowd : {&alone, &beside}) {
    crowd->hurt(crowd->agentId(0, 3), 2);
    simulate(device(), *crowd, 60);
  }
  const HerdState a = alone.download(0), b = beside.download(0);
  EXPECT_TRUE(sameBits(a.body, b.body));
  EXPECT_TRUE(sameBits(a.hurt, b.hurt));
  EXPECT_TRUE(b.search.empty());
  EXPECT_FALSE(beside.download(1).search.empty());
}

// Nobody who is whole has its gait written, or takes another way.
TEST_F(AdaptTest, WhoIsWholeWalksAsInAnyHerd) {
  const Heightfield ground = rollingGround();
  Scene told = hurtScene(12), adapts = told;
  adapts.herds[0].adapts = true;
  Crowd one(device(), ground, told, kAllWatched), other(device(), ground, adapts, kAllWatched);
  for (Crowd* crowd : {&one, &other}) simulate(device(), *crowd, 90);
  const HerdState a = one.download(0), b = other.download(0);
  for (const Record record : {Record::body, Record::hurt, Record::step, Record::chain})
    EXPECT_TRUE(sameBits(a.of(record), b.of(record)));
}

TEST_F(AdaptTest, WhoHealsIsAtEaseAndWhoIsHurtAgainSearchesAnew) {
  Crowd crowd(device(), flatGround(), adaptingScene(3), kAllWatched);
  const HerdState whole = crowd.download(0);
  hurtAll(crowd);
  simulate(device(), crowd, 70, longTick);
  EXPECT_EQ(crowd.searches(0)[1].trials, 1u);
  crowd.heal(crowd.agentId(0, 0));
  crowd.hurt(crowd.agentId(0, 1), 6);
  simulate(device(), crowd, 1, longTick);
  const std::vector<Search> searches = crowd.searches(0);
  EXPECT_EQ(searches[0].phase, SearchPhase::atEase);
  EXPECT_EQ(searches[1].phase, SearchPhase::searching);
  EXPECT_EQ(searches[1].trials, 0u);
  EXPECT_EQ(searches[2].trials, 1u);
  const HerdState after = crowd.download(0);
  const size_t floats = whole.hurt.size() / 3;
  EXPECT_TRUE(std::equal(whole.hurt.begin(), whole.hurt.begin() + static_cast<ptrdiff_t>(floats),
                         after.hurt.begin()));
}

TEST_F(AdaptTest, ATeleportKeepsTheSearchAndANewcomerHasNone) {
  Scene scene = adaptingScene(3);
  scene.herds[0].reserve = 1;
  Crowd crowd(device(), flatGround(), scene, kAllWatched);
  hurtAll(crowd);
  simulate(device(), crowd, 70, longTick);
  crowd.teleport(crowd.agentId(0, 1), {{3, 4}, 1});
  crowd.remove(crowd.agentId(0, 2));
  simulate(device(), crowd, 1, longTick);
  EXPECT_EQ(crowd.searches(0)[1].trials, 1u);
  const AgentId comes = crowd.add(0, {{-5, 2}, 0});
  EXPECT_EQ(comes.agent(), 2u);
  for (const uint32_t leg : {2u, 3u}) crowd.hurt(comes, leg);  // as its predecessor was
  simulate(device(), crowd, 1, longTick);
  EXPECT_EQ(crowd.searches(0)[2].trials, 0u);
  EXPECT_EQ(crowd.searches(0)[2].phase, SearchPhase::searching);
}

TEST_F(AdaptTest, AStateHasWhatTheyTried) {
  Crowd crowd(device(), rollingGround(), adaptingScene(12));
  hurtAll(crowd);
  simulate(device(), crowd, 150, longTick);
  Crowd again(device(), parseState(crowd.saveToMemory(), "adapt.state"));
  for (Crowd* each : {&crowd, &again}) simulate(device(), *each, 70, longTick);
  EXPECT_EQ(crowd.stateHash(), again.stateHash());
  EXPECT_GE(again.searches(0)[0].trials, 2u);
}

TEST_F(AdaptTest, PagesAndFusionDoNotShow) {
  const auto hashOf = [&](const CrowdOptions& options) {
    Crowd crowd(device(), rollingGround(), adaptingScene(40), options);
    hurtAll(crowd);
    simulate(device(), crowd, 140, longTick);
    return crowd.stateHash();
  };
  const uint64_t whole = hashOf({});
  EXPECT_EQ(whole, hashOf({.pageAgents = 7}));
  EXPECT_EQ(whole, hashOf({.fuse = false}));
  EXPECT_EQ(whole, hashOf(kAllWatched));
}

TEST_F(AdaptTest, WhoStandsTriesNothing) {
  Scene scene = adaptingScene(4);
  scene.herds[0].goal.kind = Goal::Kind::none;
  CrowdOptions options = kAllWatched;
  options.sleep = true;
  Crowd crowd(device(), flatGround(), scene, options);
  hurtAll(crowd);
  simulate(device(), crowd, 140, longTick);
  for (const Search& each : crowd.searches(0)) {
    EXPECT_EQ(each.phase, SearchPhase::searching);
    EXPECT_EQ(each.trials, 0u);
  }
  EXPECT_EQ(crowd.sleeping(), 4u);
}

// Those who avoid, forage or have reactions, and rigs of other numbers of legs.
TEST_F(AdaptTest, EveryHerdThatCanBeHurtIsFollowed) {
  Scene scene = adaptingScene(9);
  scene.herds[0].avoid = scene.herds[0].reactions = true;
  scene.herds.push_back(adaptingScene(6).herds[0]);
  scene.herds[1].rig = SKITTER_ROOT "/assets/quadruped.glb";
  scene.herds[1].spawn.centre = {20, 0};
  Crowd crowd(device(), rollingGround(), scene, kAllWatched);
  crowd.hurt(crowd.agentId(0, 4), 2);
  for (uint32_t agent = 0; agent < 6; ++agent) crowd.hurt(crowd.agentId(1, agent), agent % 4);
  for (const auto& results : replayAll(device(), crowd, rollingGround(), 150, longTick))
    expectAllPass(results);
  EXPECT_GE(crowd.searches(0)[4].trials, 2u);
  EXPECT_GE(crowd.searches(1)[0].trials, 2u);
}

TEST_F(AdaptInputTest, NamesWhatIsWrong) {
  Scene scene = adaptingScene(5);
  const auto fault = [&] { return inputFault([&] { Crowd(device(), rollingGround(), scene); }); };
  scene.herds[0].hurt = false;
  EXPECT_EQ(fault(), scene.name + ": herds[0].hurt is false, expected true: it adapts");
  scene.herds[0].hurt = true;
  scene.herds[0].controller = Controller::loop;
  EXPECT_EQ(fault(), scene.name + ": herds[0].controller is loop, expected adaptive: it adapts");
  scene.herds[0].controller = Controller::adaptive;
  scene.herds[0].forage = Forage{.load = {.mass = 1}};
  EXPECT_EQ(fault(), scene.name + ": herds[0]: adapts is true, expected false where agents carry");
  scene.herds[0].forage.reset();
  scene.events = {{0, LoadChange{.herd = 0, .load = {.mass = 1}}}};
  EXPECT_EQ(fault(), scene.name + ": events[0]: herd 0: adapts is true, expected false where agents carry");
  scene.events.clear();
  Crowd crowd(device(), rollingGround(), scene);
  EXPECT_EQ(inputFault([&] { crowd.carry(crowd.agentId(0, 2), {.mass = 1}); }),
            "herd 0, agent 2: adapts is true, expected false where agents carry");
}

// assets/scenes/trial-and-error.json.
TEST_F(AdaptInputTest, ExampleRuns) {
  const Scene scene = loadScene(SKITTER_ROOT "/assets/scenes/trial-and-error.json");
  Crowd crowd(device(), scene.loadTerrain(), scene);
  simulate(device(), crowd, 300);
  uint32_t searching = 0;
  for (const Search& each : crowd.searches(0)) searching += each.phase != SearchPhase::atEase;
  EXPECT_GT(searching, scene.herds[0].agents / 2);
}

}  // namespace
}  // namespace skitter::test

// Herds whose agents differ in size: each size is a run of the herd's agents, of a kind of its own.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "crowd/kinds.h"
#include "crowd/page.h"
#include "crowd/readback.h"
#include "crowd/scale.h"
#include "crowd/simulation.h"
#include "skitter/error.h"
#include "skitter/readback.h"
#include "skitter/state.h"

namespace skitter::test {
namespace {

using ::testing::HasSubstr, ::testing::ThrowsMessage;

class SizesTest : public GpuTest {};
class SizedControllersTest : public GpuTest, public ::testing::WithParamInterface<Controller> {};
class SizedRigsTest : public SizedControllersTest {};
class SizesInputTest : public GpuTest {};

Scene sizedScene(uint32_t agents, std::vector<float> sizes, Controller controller = Controller::adaptive) {
  Scene scene = sceneOf(agents, 1, 5, controller);
  scene.herds[0].sizes = std::move(sizes);
  return scene;
}
// In a square of which every agent keeps its place, whatever its size.
Scene sizedGrid(uint32_t agents, std::vector<float> sizes, Controller controller = Controller::adaptive) {
  Scene scene = sizedScene(agents, std::move(sizes), controller);
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 4};
  return scene;
}
const CrowdOptions kEverything{.watchEvery = 1, .feet = true, .footfalls = UINT32_MAX, .pageAgents = 8};

bool isThere(const HerdState& state, size_t agent) {
  return state.body[agent * 4 * shared::BODY_STRIDE + 7] == 0;
}
float goalOf(const HerdState& state, size_t agent, size_t number) {
  return state.goal[agent * 4 * shared::GOAL_STRIDE + number];
}

void expectSameAgents(const Crowd& a, const Crowd& b) {
  EXPECT_EQ(a.stateHash(), b.stateHash());
  ASSERT_EQ(a.herdCount(), b.herdCount());
  for (uint32_t h = 0; h < a.herdCount(); ++h) {
    ASSERT_EQ(a.places(h), b.places(h));
    EXPECT_EQ(a.agentCount(h), b.agentCount(h));
    EXPECT_EQ(a.download(h).pose, b.download(h).pose);
    EXPECT_EQ(a.footfalls(h).size(), b.footfalls(h).size());
    EXPECT_EQ(a.fidelity(h).agentTicks, b.fidelity(h).agentTicks);
    EXPECT_EQ(a.fidelity(h).reachErrorP99, b.fidelity(h).reachErrorP99);
    for (uint32_t agent = 0; agent < a.places(h); ++agent) EXPECT_EQ(a.size(h, agent), b.size(h, agent));
  }
}

// At 1 m/s, half a leg length to two a second.
TEST_P(SizedControllersTest, AreReplayed) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device(), ground, sizedScene(24, {0.5f, 1, 2}, GetParam()), kEverything);
  const auto results = replayAll(device(), crowd, ground, 90);
  ASSERT_EQ(results.size(), 3u);
  for (const auto& each : results) {
    expectAllPass(each);
    for (const validation::StageResult& stage : each) EXPECT_GT(stage.samples, 0u) << stage.name;
  }
}

// A creature of twice the size moves as a rig of twice the size does, bit for bit.
TEST_P(SizedRigsTest, MoveAsARigOfThatSizeDoes) {
  const Heightfield ground = rollingGround();
  Crowd sized(device(), ground, sizedScene(20, {2}, GetParam()));
  Crowd rigged(device(), ground, sizedScene(20, {}, GetParam()), {.rigs = {crowd::scaled(spiderRig(), 2)}});
  for (Crowd* crowd : {&sized, &rigged}) simulate(device(), *crowd, 60);
  EXPECT_EQ(sized.stateHash(), rigged.stateHash());
  EXPECT_EQ(sized.rig(0), rigged.rig(0));
}

TEST_P(SizedControllersTest, GoOnFromAState) {
  Scene scene = sizedGrid(20, {0.5f, 1}, GetParam());
  scene.herds[0].reserve = 9;
  scene.herds.push_back(scene.herds[0]);
  scene.herds[1].sizes = {1, 2};
  Crowd crowd(device(), rollingGround(), scene, kEverything);
  ASSERT_EQ(implOf(crowd).kinds.size(), 3u);
  simulate(device(), crowd, 30);
  for (uint32_t h = 0; h < 2; ++h) {
    const HerdState state = crowd.download(h);
    for (uint32_t agent = 0; agent < state.agents; agent += 5)
      if (isThere(state, agent)) crowd.remove(crowd.agentId(h, agent));
    crowd.add(h, {{3, 4}, 1});
  }
  const std::vector<std::byte> saved = crowd.saveToMemory();
  State state = parseState(saved, "a state");
  EXPECT_TRUE(state.scene.herds == scene.herds);
  state.options.pageAgents = 0;
  Crowd again(device(), state);
  expectSameAgents(crowd, again);
  for (Crowd* each : {&crowd, &again}) simulate(device(), *each, 30);
  expectSameAgents(crowd, again);
  for (uint32_t h = 0; h < 2; ++h)
    EXPECT_EQ(crowd.add(h, {{-3, 4}, 1}).bits(), again.add(h, {{-3, 4}, 1}).bits());
}

INSTANTIATE_TEST_SUITE_P(, SizedControllersTest, ::testing::ValuesIn(allControllers),
                         [](const auto& param) { return testNameOf(param.param); });
// The others play the clips of a file, whose rig has one size.
INSTANTIATE_TEST_SUITE_P(, SizedRigsTest, ::testing::Values(Controller::adaptive, Controller::loop),
                         [](const auto& param) { return testNameOf(param.param); });

TEST_F(SizesTest, OneSizeIsNone) {
  const Heightfield ground = rollingGround();
  Crowd plain(device(), ground, sizedScene(30, {})), one(device(), ground, sizedScene(30, {1, 1}));
  ASSERT_EQ(implOf(one).kinds.size(), 1u);
  EXPECT_EQ(plain.memoryBytes(), one.memoryBytes());
  for (Crowd* crowd : {&plain, &one}) simulate(device(), *crowd, 30);
  EXPECT_EQ(plain.stateHash(), one.stateHash());
}

TEST(KindsRefusalTest, EqualSizesOfEqualHerdsShareAKind) {
  Scene scene = sizedScene(30, {0.5f, 1});
  scene.herds.resize(3, scene.herds[0]);
  scene.herds[1].sizes = {};
  scene.herds[2].sizes = {1, 3, 0.5f, 1};
  std::vector<uint32_t> kinds;
  for (const crowd::SizedHerd& herd : crowd::kindsOf(scene).herds) kinds.push_back(herd.kind);
  EXPECT_EQ(kinds, (std::vector<uint32_t>{0, 1, 1, 1, 2, 0}));
}

TEST(KindsRefusalTest, AHerdThatCannotBeIsRefused) {
  const auto faultOf = [](const std::function<void(Herd&)>& spoil) -> std::string {
    Scene scene = sizedScene(30, {});
    scene.name = "one.json";
    spoil(scene.herds[0]);
    try {
      crowd::kindsOf(scene);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::input);
      return error.what();
    }
    return "taken";
  };
  const std::string herd = "one.json: herds[0]: ";
  const float inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(faultOf([](Herd& of) { of.agents = UINT32_MAX, of.reserve = 2; }),
            herd + "4294967297 agents and reserve, expected at most 16777216");
  EXPECT_EQ(faultOf([](Herd& of) { of.spawn.spacing = 0; }),
            herd + "spawn.spacing is 0 m, expected 0.01 to 4096");
  EXPECT_EQ(faultOf([&](Herd& of) { of.spawn.spacing = inf; }),
            herd + "spawn.spacing is inf m, expected 0.01 to 4096");
  EXPECT_EQ(faultOf([&](Herd& of) { of.spawn.centre.y = -inf; }),
            herd + "spawn.centre z is -inf m, expected -4096 to 4096");
  EXPECT_EQ(faultOf([](Herd& of) { of.spawn.heading = std::nanf(""); }),
            herd + "spawn.heading is nan radians, expected -1000 to 1000");
  EXPECT_EQ(faultOf([](Herd& of) { of.goal.speed = -1; }), herd + "goal.speed is -1 m/s, expected 0 to 1000");
  EXPECT_EQ(faultOf([](Herd& of) { of.agents = UINT32_MAX; }), "taken");
}

TEST(KindsRefusalTest, SizesAreDrawnBySeedAndMixedByPlace) {
  Herd herd;
  herd.agents = 3000;
  herd.reserve = 1000;
  herd.sizes = {0.8f, 1, 1.2f, 1};
  const crowd::Numbering numbering = crowd::numberingOf(herd, 7);
  ASSERT_EQ(numbering.counts.size(), 3u);
  ASSERT_EQ(numbering.starts.size(), 4000u);
  std::set<uint32_t> all;
  uint32_t first = 0;
  for (size_t size = 0; size < 3; ++size) {
    const auto begin = numbering.starts.begin() + first, end = begin + numbering.counts[size];
    EXPECT_TRUE(std::is_sorted(begin, end));
    all.insert(begin, end);
    first += numbering.counts[size];
    // A standard deviation is 27 of 1000 and 32 of 2000, and in each half 19 and 22; size 1 is named twice.
    const double expected = size == 1 ? 2000 : 1000;
    EXPECT_NEAR(numbering.counts[size], expected, 160) << size;
    EXPECT_NEAR(std::count_if(begin, end, [](uint32_t place) { return place < 2000; }), expected / 2, 110);
  }
  EXPECT_EQ(first, 4000u);
  EXPECT_EQ(all.size(), 4000u);
  EXPECT_EQ(*all.rbegin(), 3999u);
  EXPECT_EQ(crowd::numberingOf(herd, 7).starts, numbering.starts);
  EXPECT_NE(crowd::numberingOf(herd, 8).starts, numbering.starts);
  // Who is there does not hang on how many may come.
  herd.reserve = 0;
  std::vector<uint32_t> kept = numbering.starts;
  std::erase_if(kept, [](uint32_t place) { return place >= 3000; });
  EXPECT_EQ(crowd::numberingOf(herd, 7).starts, kept);
  herd.sizes = {3, 3};
  EXPECT_TRUE(crowd::numberingOf(herd, 7).starts.empty());
  EXPECT_EQ(crowd::numberingOf(herd, 7).counts, std::vector<uint32_t>{3000});
}

TEST_F(SizesTest, AgentsStandWhereTheSpawnHasThem) {
  const Heightfield ground = rollingGround();
  const Scene scene = sizedGrid(60, {2, 0.5f});
  const Crowd crowd(device(), ground, scene, kEverything), plain(device(), ground, sizedGrid(60, {}));
  const crowd::Numbering numbering = crowd::numberingOf(scene.herds[0], scene.seed);
  const HerdState state = crowd.download(0), other = plain.download(0);
  ASSERT_EQ(state.agents, 60u);
  for (uint32_t agent = 0; agent < 60; ++agent) {
    EXPECT_EQ(crowd.size(0, agent), agent < numbering.counts[0] ? 2 : 0.5f) << agent;
    const glm::dvec3 here = positionOf(state, agent), there = positionOf(other, numbering.starts[agent]);
    EXPECT_EQ(here.x, there.x) << agent;
    EXPECT_EQ(here.z, there.z) << agent;
  }
  EXPECT_FLOAT_EQ(crowd.rig(0).legLength, 2);
  EXPECT_FLOAT_EQ(crowd.rig(0, 59).legLength, 0.5f);
}

TEST_F(SizesTest, AgentsAreNumberedSizeAfterSize) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device(), ground, sizedScene(41, {2, 0.5f}), kEverything);
  const Crowd::Impl& impl = implOf(crowd);
  const std::vector<crowd::SizeRun>& runs = impl.herds[0].runs;
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].agents + runs[1].agents, 41u);
  simulate(device(), crowd, 50);
  const HerdState all = crowd.download(0);
  const HerdState first = crowd::download(impl, runs[0]), last = crowd::download(impl, runs[1]);
  for (const Record record : {Record::body, Record::step, Record::chain, Record::pose, Record::foot}) {
    std::vector<float> joined = first.of(record);
    joined.insert(joined.end(), last.of(record).begin(), last.of(record).end());
    EXPECT_FALSE(joined.empty());
    EXPECT_EQ(all.of(record), joined);
  }
  EXPECT_TRUE(all.watch.empty());
  EXPECT_FALSE(first.watch.empty());
  // Every third agent, across the two sizes.
  const HerdState some = crowd.download(0, {.first = 1, .stride = 3});
  ASSERT_EQ(some.agents, 14u);
  for (uint32_t i = 0; i < some.agents; ++i) EXPECT_EQ(positionOf(some, i), positionOf(all, 1 + 3 * i)) << i;
  // A touchdown is near the agent whose number it has.
  std::set<uint32_t> landed;
  for (int tick = 0; tick < 60; ++tick) {
    simulate(device(), crowd, 1);
    const HerdState state = crowd.download(0);
    EXPECT_TRUE(state.footfallsKept);
    for (const Footfall& f : state.footfalls) {
      const glm::dvec3 body = positionOf(state, f.agent);
      EXPECT_LT(glm::distance(body, glm::dvec3(f.place)), 1.2 * crowd.rig(0, f.agent).legLength) << f.agent;
      landed.insert(f.agent);
    }
  }
  EXPECT_GT(landed.size(), 35u);
  std::map<uint32_t, uint32_t> agents;
  for (const FootfallBuffer& buffer : crowd.footfallBuffers(0)) agents[buffer.firstOfHerd] = buffer.agents;
  EXPECT_EQ(agents, (std::map<uint32_t, uint32_t>{{0, runs[0].agents}, {runs[0].agents, runs[1].agents}}));
  uint32_t next = 0;
  for (const GoalBuffer& buffer : crowd.goalBuffers(0)) {
    EXPECT_EQ(buffer.firstAgent, next);
    next += buffer.agents;
  }
  EXPECT_EQ(next, 41u);
}

TEST_F(SizesTest, FiguresAreOfAllSizesInLegLengthsOfEach) {
  Crowd crowd(device(), flatGround(), sizedScene(30, {0.5f, 2}), CrowdOptions{.watchEvery = 1});
  simulate(device(), crowd, 120);
  const std::vector<Fidelity> each = crowd.agentFidelity(0);
  ASSERT_EQ(each.size(), 30u);
  uint64_t ticks = 0, stances = 0;
  double margin = 0;
  for (const Fidelity& f : each) {
    EXPECT_EQ(f.agentTicks, 120u);
    // Standing on a spider's feet its middle is a good part of a leg length from the edge of their hull.
    EXPECT_GT(f.margin, 0.1);
    EXPECT_LT(f.margin, 1);
    ticks += f.agentTicks;
    stances += f.stances;
    margin += f.margin / 30;
  }
  const Fidelity all = crowd.fidelity(0);
  EXPECT_EQ(all.agentTicks, ticks);
  EXPECT_EQ(all.stances, stances);
  EXPECT_NEAR(all.margin, margin, 0.01);
  uint64_t bytes = 0;
  for (const MemoryUse& use : crowd.memoryUse(0)) bytes += use.bytes;
  EXPECT_EQ(bytes, crowd.memoryBytes());
}

// What is said of an agent reaches it and nobody else, whatever its size.
TEST_F(SizesTest, EachIsSteeredByItsNumber) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device(), ground, sizedGrid(40, {2, 0.5f, 1}), kEverything);
  simulate(device(), crowd, 5);
  std::vector<Goal> goals;
  std::vector<float> speeds;
  for (uint32_t agent = 0; agent < 40; ++agent) {
    goals.push_back({.kind = Goal::Kind::point, .target = {static_cast<float>(agent), 3}});
    speeds.push_back(0.5f + 0.01f * static_cast<float>(agent));
  }
  crowd.steer(0, goals);
  crowd.setSpeed(0, speeds);
  const AgentGoal still{crowd.agentId(0, 39), {.kind = Goal::Kind::none}};
  crowd.steer({&still, 1});
  std::vector<AgentPlace> places;
  for (uint32_t agent = 0; agent < 40; agent += 3)
    places.push_back({crowd.agentId(0, agent), {{-static_cast<float>(agent), 7}, 1}});
  crowd.teleport(places);
  crowd::applyChanges(implOf(crowd));
  const HerdState state = crowd.download(0);
  for (uint32_t agent = 0; agent < 40; ++agent) {
    EXPECT_EQ(goalOf(state, agent, 5), 0.5f * crowd.rig(0, agent).legLength) << agent;
    if (agent % 3 == 0) {
      EXPECT_NEAR(positionOf(state, agent).x, -static_cast<float>(agent), 1e-5) << agent;
      EXPECT_NEAR(positionOf(state, agent).z, 7, 1e-5) << agent;
      // As far from its first foot as one of its size.
      EXPECT_NEAR(
          glm::length(glm::vec2(state.tip[32 * agent], state.tip[32 * agent + 2])),
          glm::length(glm::vec2(crowd.rig(0, agent).legs[0].home.x, crowd.rig(0, agent).legs[0].home.z)),
          0.3f * crowd.rig(0, agent).legLength)
          << agent;
    }
    if (agent == 39) continue;
    EXPECT_EQ(goalOf(state, agent, 0), static_cast<float>(agent));
    EXPECT_EQ(goalOf(state, agent, 4), speeds[agent]) << agent;
  }
  EXPECT_EQ(goalOf(state, 39, 6), shared::GOAL_NONE);
  for (const auto& each : replayAll(device(), crowd, ground, 30)) expectAllPass(each);
}

// Its place decides how large a newcomer is.
TEST_F(SizesTest, AgentsComeAndGo) {
  const Heightfield ground = rollingGround();
  Scene scene = sizedGrid(12, {0.5f, 2});
  scene.herds[0].reserve = 12;
  Crowd crowd(device(), ground, scene, kEverything);
  const crowd::Numbering numbering = crowd::numberingOf(scene.herds[0], scene.seed);
  EXPECT_EQ(crowd.agentCount(), 12u);
  EXPECT_EQ(crowd.places(0), 24u);
  std::vector<uint32_t> empty;
  const HerdState began = crowd.download(0);
  for (uint32_t place = 0; place < 24; ++place) {
    EXPECT_EQ(isThere(began, place), numbering.starts[place] < 12) << place;
    EXPECT_EQ(crowd.has(AgentId(0, place)), numbering.starts[place] < 12) << place;
    if (!isThere(began, place)) empty.push_back(place);
  }
  simulate(device(), crowd, 10);
  for (const uint32_t place : empty) {
    const AgentId came = crowd.add(0, {{static_cast<float>(place), -5}, 0});
    EXPECT_EQ(came.agent(), place);
  }
  EXPECT_THAT([&] { crowd.add(0, {}); },
              ThrowsMessage<Error>(HasSubstr("herd 0: all of its 24 places are taken")));
  const AgentId leaver = crowd.agentId(0, 23), small = crowd.agentId(0, 0);
  crowd.remove(leaver);
  crowd.remove(small);
  EXPECT_FALSE(crowd.has(leaver));
  crowd::applyChanges(implOf(crowd));
  const HerdState state = crowd.download(0);
  for (uint32_t place = 0; place < 24; ++place) {
    EXPECT_EQ(isThere(state, place), place != 0 && place != 23) << place;
    if (isThere(state, place) && !isThere(began, place)) {
      EXPECT_NEAR(positionOf(state, place).x, static_cast<double>(place), 1e-5);
      EXPECT_EQ(goalOf(state, place, 5), 0.5f * crowd.rig(0, place).legLength) << place;
    }
  }
  for (const auto& each : replayAll(device(), crowd, ground, 60)) expectAllPass(each);
  EXPECT_EQ(crowd.agentCount(), 22u);
}

// A scene's events number agents as the host does.
TEST_F(SizesTest, EventsAreWhatTheCallerCouldDo) {
  const Heightfield ground = rollingGround();
  Scene plain = sizedGrid(20, {2, 0.5f});
  plain.herds[0].reserve = 6;
  std::vector<uint32_t> here;
  const crowd::Numbering numbering = crowd::numberingOf(plain.herds[0], plain.seed);
  for (uint32_t place = 0; place < 26; ++place)
    if (numbering.starts[place] < 20) here.push_back(place);
  const uint32_t first = here.front(), last = here.back();
  const Goal goal{.kind = Goal::Kind::point, .target = {6, -3}, .speed = 0.5f};
  Scene scene = plain;
  scene.events = {{0.1f, GoalChange{.agents = {first, last}, .goal = goal}},
                  {0.1f, SpeedChange{.speed = 0.25f}},
                  {0.1f, Teleport{.moves = {{last, {{7, 8}, 1}}}}},
                  {0.1f, Removal{.agents = {first}}},
                  {0.1f, Addition{.arrivals = {{.place = {{3, 3}, 0}}, {.place = {{-3, 3}, 0}}}}}};
  Crowd crowd(device(), ground, scene, kEverything), other(device(), ground, plain, kEverything);
  for (Crowd* each : {&crowd, &other}) simulate(device(), *each, 5);
  const std::vector<AgentGoal> goals{{other.agentId(0, first), goal}, {other.agentId(0, last), goal}};
  other.steer(goals);
  other.setSpeed(0, 0.25f);
  other.teleport(other.agentId(0, last), {{7, 8}, 1});
  other.remove(other.agentId(0, first));
  other.add(0, {{3, 3}, 0});
  other.add(0, {{-3, 3}, 0});
  for (const int ticks : {1, 20}) {
    for (Crowd* each : {&crowd, &other}) simulate(device(), *each, ticks);
    expectSameAgents(crowd, other);
    EXPECT_EQ(crowd.agentCount(), 21u);
  }
  const HerdState state = crowd.download(0);
  EXPECT_NEAR(positionOf(state, last).x, 7, 0.5);
  EXPECT_NEAR(positionOf(state, last).z, 8, 0.5);
}

TEST_F(SizesTest, AHerdThatComesIsAsOneThatWasThere) {
  const Heightfield ground = rollingGround();
  Scene one = sizedGrid(10, {}), two = one;
  two.herds.push_back(sizedGrid(14, {0.5f, 2, 3}, Controller::loop).herds[0]);
  Crowd there(device(), ground, two, kEverything), came(device(), ground, one, kEverything);
  const uint64_t bytes = came.memoryBytes();
  const HerdId herd = came.addHerd(two.herds[1]);
  for (Crowd* crowd : {&there, &came}) simulate(device(), *crowd, 20);
  expectSameAgents(there, came);
  EXPECT_EQ(came.memoryBytes(), there.memoryBytes());
  const AgentId agent = came.agentId(1, 13);
  came.removeHerd(herd);
  EXPECT_FALSE(came.has(agent));
  EXPECT_EQ(came.memoryBytes(), bytes);
  EXPECT_EQ(came.download(1).agents, 0u);
  // What it leaves free is taken again.
  const size_t kinds = implOf(came).kinds.size();
  const HerdId again = came.addHerd(two.herds[1]);
  EXPECT_EQ(again, (HerdId{1, 2}));
  EXPECT_EQ(implOf(came).kinds.size(), kinds);
  EXPECT_TRUE(came.has(came.agentId(1, 13)));
  simulate(device(), came, 5);
  EXPECT_EQ(came.fidelity(1).agentTicks, 14u * 5);
}

// One of its sizes shares pages with another herd, the other has its own.
TEST_F(SizesTest, AHerdThatSharesASizeLeavesItsPlacesEmpty) {
  Scene scene = sizedGrid(9, {1, 2});
  scene.herds[0].reserve = 1;
  scene.herds.push_back(scene.herds[0]);
  scene.herds[1].sizes = {1};
  Crowd crowd(device(), flatGround(), scene, kEverything);
  simulate(device(), crowd, 3);
  crowd.removeHerd(crowd.herdId(0));
  EXPECT_EQ(crowd.agentCount(), 9u);
  simulate(device(), crowd, 3);
  EXPECT_EQ(crowd.fidelity(1).agentTicks, 9u * 6);
  scene.herds[0].reserve = scene.herds[1].reserve = 0;
  Crowd without(device(), flatGround(), scene);
  EXPECT_THAT([&] { without.removeHerd(without.herdId(0)); },
              ThrowsMessage<Error>(HasSubstr("herd 0: shares pages with other herds")));
}

TEST_F(SizesInputTest, ThatCannotBeAreRefused) {
  const Heightfield ground = flatGround();
  const auto refusalOf = [&](const std::vector<float>& sizes) {
    return [&ground, sizes, this] { Crowd(device(), ground, sizedScene(4, sizes)); };
  };
  const auto refuses = [](const char* what) { return ThrowsMessage<Error>(HasSubstr(what)); };
  EXPECT_THAT(refusalOf(std::vector<float>(17, 1.0f)), refuses("herds[0].sizes are 17, expected at most 16"));
  EXPECT_THAT(refusalOf({1, 0.04f}), refuses("herds[0].sizes[1] is 0.04, expected 0.05 to 20"));
  EXPECT_THAT(refusalOf({21}), refuses("herds[0].sizes[0] is 21"));
  EXPECT_THAT(refusalOf({std::numeric_limits<float>::quiet_NaN()}), refuses("herds[0].sizes[0] is nan"));
  Crowd crowd(device(), ground, sizedScene(4, {1, 2}));
  EXPECT_THAT([&] { crowd.size(0, 4); }, refuses("herd 0, agent 4: expected one of its 4 places"));
  Herd herd = sizedScene(4, {1, 30}).herds[0];
  EXPECT_THAT([&] { crowd.addHerd(herd); }, refuses("a new herd: herds[0].sizes[1] is 30"));
  EXPECT_EQ(crowd.herdCount(), 1u);
  State state = parseState(crowd.saveToMemory(), "a state");
  state.scene.herds[0].sizes = {1, 2, 3};
  EXPECT_THAT([&] { Crowd(device(), state); }, refuses("a state: herd 0 has other sizes than in its scene"));
}

}  // namespace
}  // namespace skitter::test

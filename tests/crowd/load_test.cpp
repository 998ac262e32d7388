// What agents carry: what it does to a gait, and to a crowd (docs/loads.md).
#include "crowd/load.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "assets/files.h"
#include "cpu_reference/stages/hurt.h"
#include "cpu_reference/stages/measure.h"
#include "crowd/damage.h"
#include "crowd/follow.h"
#include "crowd/simulation.h"
#include "shared/forage.h"
#include "skitter/error.h"
#include "skitter/state.h"
#include "validation/convert.h"
#include "validation/lockstep/lockstep.h"

namespace skitter::test {
namespace {

using crowd::combinedCentre, crowd::loaded, crowd::LegPattern, crowd::Regait;

struct Loaded {
  Rig rig = spiderRig();
  Tuning tuning;

  Regait own(const LegPattern& pattern = {}) const { return crowd::regaitFor(rig, tuning, pattern); }
  Regait with(const Load& load, const LegPattern& pattern = {}) const {
    return loaded(own(pattern), load, rig, tuning, pattern);
  }
};

TEST(LoadLaw, NoneLeavesTheGait) {
  const Loaded spider;
  const LegPattern lame{.lame = 2};
  const Regait own = spider.own(lame), same = spider.with({.mass = 0, .offset = {1, 1, 1}}, lame);
  EXPECT_EQ(same.shift, own.shift);
  EXPECT_EQ(same.speed, own.speed);
  for (size_t leg = 0; leg < 8; ++leg) EXPECT_EQ(same.legs[leg].slowness, own.legs[leg].slowness);
}

// All values below are exact but for the roundings of a handful of float operations: EXPECT_FLOAT_EQ's 4 ulp.
TEST(LoadLaw, OwnMassHalvesSpeedAndOffset) {
  const Loaded spider;
  const Load load{.mass = 1, .offset = {0, 0.1f, -0.2f}};
  EXPECT_FLOAT_EQ(combinedCentre(load).y, 0.05f);
  EXPECT_FLOAT_EQ(combinedCentre(load).z, -0.1f);
  const LegPattern lame{.lame = 1};
  const Regait own = spider.own(lame), slow = spider.with(load, lame);
  EXPECT_FLOAT_EQ(slow.speed, 0.5f * own.speed);
  EXPECT_FLOAT_EQ(slow.shift.x, own.shift.x);
  EXPECT_FLOAT_EQ(slow.shift.z, own.shift.z - 0.1f * spider.rig.legLength);
  for (size_t leg = 0; leg < 8; ++leg) EXPECT_EQ(slow.legs[leg].slowness, own.legs[leg].slowness);
  EXPECT_EQ(slow.groups, own.groups);
}

TEST(LoadLaw, TheBodySinksUnderALoad) {
  const Loaded spider;
  for (const float mass : {0.25f, 1.0f, 4.0f})
    EXPECT_FLOAT_EQ(spider.with({.mass = mass}).shift.y, 0.2f * mass / (1 + mass) * spider.rig.bodyHeight);
}

TEST(LoadLaw, LeanHasALimitAndFeetAreWithinReach) {
  const Loaded spider;
  const Load far{.mass = 4, .offset = {2, 0, 0}};
  for (const uint32_t idle : {0u, 1u, 0x12u}) {
    const LegPattern pattern{.idle = idle};
    const Regait own = spider.own(pattern), leaning = spider.with(far, pattern);
    const double lean = std::hypot(double{leaning.shift.x}, double{leaning.shift.z});
    const double before = std::hypot(double{own.shift.x}, double{own.shift.z});
    EXPECT_NEAR(lean, std::max(0.3 * double{spider.rig.legLength}, before), 1e-5);
    // docs/damage.md, Centres: unless it was lowered as far as it may be.
    for (size_t l = 0; l < 8; ++l) {
      const Leg& leg = spider.rig.legs[l];
      if ((idle >> l & 1u) != 0 || leaning.shift.y >= 0.3f * spider.rig.bodyHeight) continue;
      const float most =
          std::max(spider.tuning.reachComfort * leg.reach, glm::distance(leg.home, leg.root()));
      EXPECT_LE(glm::distance(leg.home + leaning.shift, leg.root()), 1.0001f * most) << leg.name;
    }
  }
}

// The load's centre lies as far the other way as the lost legs make the body lean.
TEST(LoadLaw, ALoadThatRightsTheBodyDoesNotRaiseIt) {
  const Loaded spider;
  int lowered = 0;
  for (uint32_t first = 0; first < 8; ++first)
    for (uint32_t second = first + 1; second < 8; ++second) {
      const LegPattern pattern{.idle = 1u << first | 1u << second};
      const Regait own = spider.own(pattern);
      if (own.shift.y <= 0) continue;
      ++lowered;
      const glm::vec3 offset = glm::vec3(own.shift.x, 0, own.shift.z) * (-2 / spider.rig.legLength);
      const Regait righted = spider.with({.mass = 1, .offset = offset}, pattern);
      EXPECT_NEAR(righted.shift.x, 0, 1e-6) << pattern.idle;
      EXPECT_FLOAT_EQ(righted.shift.y, own.shift.y + 0.1f * spider.rig.bodyHeight) << pattern.idle;
    }
  EXPECT_GT(lowered, 0);
}
TEST(LoadLaw, WhoLiesOnItsBellyCarriesWithoutAGait) {
  const Loaded spider;
  const LegPattern two{.idle = 0xfc};
  const Regait own = spider.own(two), same = spider.with({.mass = 2, .offset = {0, 0, 1}}, two);
  EXPECT_EQ(same.shift, own.shift);
  EXPECT_EQ(same.speed, 0);
}

// The two masses, one by one.
TEST(LoadLaw, TheReferenceHasTheSameCentre) {
  for (const float mass : {0.0f, 0.3f, 1.0f, 4.0f}) {
    const Load load{.mass = mass, .offset = {0.1f, -0.7f, 1.3f}};
    const glm::dvec3 own(0), its(load.offset);
    const glm::dvec3 mean = (own + double{mass} * its) / (1 + double{mass});
    EXPECT_NEAR(glm::distance(glm::dvec3(combinedCentre(load)), mean), 0, 1e-6);
    EXPECT_NEAR(glm::distance(reference::centreWith(double{mass}, its), mean), 0, 1e-12);
  }
}

class LoadTest : public GpuTest, public ::testing::WithParamInterface<Controller> {};
using LoadGaitTest = GpuTest;
using LoadReplayTest = GpuTest;
using LoadInputTest = GpuTest;

const Load kBehind{.mass = 1, .offset = {0, 0.1f, -0.4f}};

std::vector<float> recordOf(const HerdState& state, Record record, size_t agent) {
  const std::vector<float>& from = state.of(record);
  const size_t each = from.size() / state.agents;
  return {from.begin() + static_cast<ptrdiff_t>(agent * each),
          from.begin() + static_cast<ptrdiff_t>((agent + 1) * each)};
}

TEST_P(LoadTest, OthersDoNotNotice) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device(), ground, hurtScene(24, GetParam()), kAllWatched),
      same(device(), ground, hurtScene(24, GetParam()), kAllWatched);
  for (Crowd* each : {&crowd, &same}) simulate(device(), *each, 20);
  crowd.carry(crowd.agentId(0, 9), kBehind);
  for (Crowd* each : {&crowd, &same}) simulate(device(), *each, 40);
  const HerdState ours = crowd.download(0), theirs = same.download(0);
  for (const size_t agent : {size_t{0}, size_t{8}, size_t{10}, size_t{23}})
    for (const Record record : {Record::body, Record::gait, Record::pose, Record::metric, Record::hurt})
      EXPECT_EQ(recordOf(ours, record, agent), recordOf(theirs, record, agent)) << agent;
  EXPECT_NE(recordOf(ours, Record::pose, 9), recordOf(theirs, Record::pose, 9));
  EXPECT_NE(crowd.stateHash(), same.stateHash());
}

// A load that is laid down leaves the gait as it was.
TEST_P(LoadTest, WhoLaysItDownWalksAsBefore) {
  Crowd crowd(device(), flatGround(), hurtScene(4, GetParam()), kAllWatched);
  simulate(device(), crowd, 20);
  const HerdState before = crowd.download(0);
  const AgentId agent = crowd.agentId(0, 1);
  EXPECT_EQ(crowd.carried(agent), Load{});
  crowd.carry(agent, kBehind);
  EXPECT_EQ(crowd.carried(agent), kBehind);
  simulate(device(), crowd, 60);
  const HerdState laden = crowd.download(0);
  EXPECT_NE(recordOf(before, Record::hurt, 1), recordOf(laden, Record::hurt, 1));
  EXPECT_EQ(recordOf(laden, Record::carried, 1), (std::vector<float>{0, 0.1f, -0.4f, 1}));
  crowd.carry(agent, {});
  simulate(device(), crowd, 1);
  const HerdState after = crowd.download(0);
  EXPECT_EQ(recordOf(before, Record::hurt, 1), recordOf(after, Record::hurt, 1));
  EXPECT_EQ(recordOf(after, Record::carried, 1), std::vector<float>(4));
  EXPECT_EQ(crowd.carried(agent), Load{});
}

TEST_P(LoadTest, AStateHasWhatTheyCarry) {
  const Heightfield ground = rollingGround();
  Scene scene = hurtScene(14, GetParam());
  scene.herds[0].reserve = 4;
  CrowdOptions options = kAllWatched;
  for (const bool measured : {true, false}) {
    options.measure = measured;  // nobody looks at the record then
    Crowd crowd(device(), ground, scene, options);
    simulate(device(), crowd, 20);
    crowd.carry(crowd.agentId(0, 3), kBehind);
    crowd.carry(crowd.agentId(0, 4), kBehind);
    simulate(device(), crowd, 20);
    crowd.carry(crowd.agentId(0, 4), {});  // these wait for the next tick
    crowd.carry(crowd.agentId(0, 5), {.mass = 0.1f, .offset = {0.3f, 0, 0}});
    const State state = parseState(crowd.saveToMemory(), "load.state");
    Crowd again(device(), state);
    for (Crowd* each : {&crowd, &again}) {
      EXPECT_EQ(each->carried(each->agentId(0, 3)), kBehind);
      EXPECT_EQ(each->carried(each->agentId(0, 4)), Load{});
      EXPECT_EQ(each->carried(each->agentId(0, 5)), (Load{.mass = 0.1f, .offset = {0.3f, 0, 0}}));
      simulate(device(), *each, 20);
      each->hurt(each->agentId(0, 3), 2);  // the gait is of all that was said
      simulate(device(), *each, 20);
    }
    EXPECT_EQ(crowd.stateHash(), again.stateHash());
    EXPECT_EQ(crowd.download(0).metric, again.download(0).metric);
  }
}

TEST_P(LoadTest, TeleportKeepsItAndNewcomersCarryNothing) {
  Scene scene = hurtScene(6, GetParam());
  scene.herds[0].reserve = 1;
  Crowd crowd(device(), rollingGround(), scene, kAllWatched);
  const AgentId agent = crowd.agentId(0, 2);
  crowd.carry(agent, kBehind);
  simulate(device(), crowd, 10);
  crowd.teleport(agent, {{3, 4}, 1});
  simulate(device(), crowd, 10);
  EXPECT_EQ(recordOf(crowd.download(0), Record::carried, 2)[3], 1);
  EXPECT_EQ(crowd.carried(agent), kBehind);
  crowd.remove(agent);
  simulate(device(), crowd, 1);
  const AgentId born = crowd.add(0, {{1, 1}, 0});
  EXPECT_EQ(born.agent(), 2u);
  EXPECT_EQ(crowd.carried(born), Load{});
  simulate(device(), crowd, 1);
  EXPECT_EQ(recordOf(crowd.download(0), Record::carried, 2), std::vector<float>(4));
}

TEST_P(LoadTest, PagesAndFusionDoNotShow) {
  const auto hashOf = [&](const CrowdOptions& options) {
    Crowd crowd(device(), rollingGround(), hurtScene(40, GetParam()), options);
    simulate(device(), crowd, 10);
    for (uint32_t agent = 0; agent < 40; agent += 3) crowd.carry(crowd.agentId(0, agent), kBehind);
    simulate(device(), crowd, 40);
    return crowd.stateHash();
  };
  const uint64_t whole = hashOf({});
  EXPECT_EQ(whole, hashOf({.pageAgents = 7}));
  EXPECT_EQ(whole, hashOf({.fuse = false}));
  EXPECT_EQ(whole, hashOf(kAllWatched));
}

INSTANTIATE_TEST_SUITE_P(, LoadTest,
                         ::testing::Values(Controller::adaptive, Controller::loop, Controller::planted),
                         [](const auto& param) { return testNameOf(param.param); });

TEST_F(LoadGaitTest, WhoSleepsWakes) {
  Scene scene = hurtScene(6);
  scene.herds[0].goal.kind = Goal::Kind::none;
  CrowdOptions options = kAllWatched;
  options.sleep = true;
  Crowd crowd(device(), flatGround(), scene, options);
  simulate(device(), crowd, 300);
  ASSERT_EQ(crowd.sleeping(), 6u);
  crowd.carry(crowd.agentId(0, 1), kBehind);
  simulate(device(), crowd, 1);
  EXPECT_EQ(crowd.sleeping(), 5u);
}

// docs/loads.md: one agent for each load, on flat ground at 1 m/s, and what each of them comes to.
struct Walk {
  double speed, height, margin, unstable, duty, reachError;
};
std::vector<Walk> walksWith(Device& device, const std::vector<Load>& loads) {
  const auto agents = static_cast<uint32_t>(loads.size());
  Scene scene = hurtScene(agents);
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 3};
  scene.herds[0].goal = {.kind = Goal::Kind::velocity, .velocity = {0, 1}};
  Crowd crowd(device, flatGround(), scene, kAllWatched);
  for (uint32_t a = 0; a < agents; ++a) crowd.carry(crowd.agentId(0, a), loads[a]);
  simulate(device, crowd, 180);
  const HerdState before = crowd.download(0);
  std::vector<double> height(agents), planted(agents), unstable(agents), margin(agents), error(agents);
  constexpr int ticks = 360;
  const auto legs = static_cast<size_t>(crowd.rig(0).legCount());
  for (int i = 0; i < ticks; ++i) {
    simulate(device, crowd, 1);
    const HerdState state = crowd.download(0);
    for (size_t a = 0; a < agents; ++a) {
      height[a] += positionOf(state, a).y / ticks;
      for (size_t leg = a * legs; leg < (a + 1) * legs; ++leg) {
        planted[a] += plantedOf(state, leg) / (double{ticks} * static_cast<double>(legs));
        error[a] = std::max(error[a], double{state.tip[4 * leg + 3]} / double{crowd.rig(0).legLength});
      }
    }
  }
  const HerdState after = crowd.download(0);
  std::vector<Walk> walks;
  for (size_t a = 0; a < agents; ++a) {
    const auto sum = [&](int vec, int at) {
      const auto i = 4 * (static_cast<size_t>(shared::METRIC_STRIDE) * a + static_cast<size_t>(vec)) +
                     static_cast<size_t>(at);
      return double{after.metric[i]} - double{before.metric[i]};
    };
    walks.push_back({.speed = (positionOf(after, a).z - positionOf(before, a).z) / (ticks * double{kTick}),
                     .height = height[a],
                     .margin = sum(5, 0) / sum(4, 2) / double{crowd.rig(0).legLength},
                     .unstable = sum(4, 3) / ticks,
                     .duty = planted[a],
                     .reachError = error[a]});
  }
  return walks;
}

TEST_F(LoadGaitTest, WhoCarriesGoesSlowerAndLowerAndStandsLonger) {
  const std::vector<Load> loads{{}, {.mass = 0.25f}, {.mass = 1}, {.mass = 4}};
  const std::vector<Walk> walks = walksWith(device(), loads);
  for (size_t a = 0; a < loads.size(); ++a) {
    // 2 %: a body that sways does not go straight.
    EXPECT_NEAR(walks[a].speed, walks[0].speed / (1 + double{loads[a].mass}), 0.02) << loads[a].mass;
    EXPECT_EQ(walks[a].unstable, 0) << loads[a].mass;
    EXPECT_LT(walks[a].reachError, 0.01) << loads[a].mass;
    if (a == 0) continue;
    EXPECT_LT(walks[a].height, walks[a - 1].height - 0.01 * double{spiderRig().bodyHeight});
    EXPECT_GT(walks[a].duty, walks[a - 1].duty);
  }
}

// The homes are below the combined centre, so a load that hangs out keeps its agent inside of its support.
TEST_F(LoadGaitTest, TheMarginIsThatOfTheCombinedCentre) {
  const std::vector<Load> loads{
      {.mass = 1}, {.mass = 1, .offset = {0, 0, -0.5f}}, {.mass = 1, .offset = {0.5f, 0, 0}}};
  const std::vector<Walk> walks = walksWith(device(), loads);
  for (size_t a = 0; a < loads.size(); ++a) {
    EXPECT_EQ(walks[a].unstable, 0) << a;
    EXPECT_NEAR(walks[a].margin, walks[0].margin, 0.05) << a;
    EXPECT_LT(walks[a].reachError, 0.01) << a;
  }
}

// An agent that stands: by how much its margin becomes less is how far its centre goes, where the homes do
// not follow it.
TEST_F(LoadGaitTest, ALoadBeyondTheLeanUpsetsWhoStands) {
  Scene scene = hurtScene(2);
  scene.herds[0].goal.kind = Goal::Kind::none;
  Crowd crowd(device(), flatGround(), scene, kAllWatched);
  crowd.carry(crowd.agentId(0, 1), {.mass = 4, .offset = {0, 0, 2}});  // its centre is 1.6 leg lengths ahead
  simulate(device(), crowd, 240);
  const HerdState before = crowd.download(0);
  simulate(device(), crowd, 60);
  const HerdState after = crowd.download(0);
  const auto unstable = [&](size_t agent) {
    const size_t at = 4 * (static_cast<size_t>(shared::METRIC_STRIDE) * agent + 4) + 3;
    return after.metric[at] - before.metric[at];
  };
  EXPECT_EQ(unstable(0), 0);
  EXPECT_EQ(unstable(1), 60);
}

// In lock step with the reference, event by event.
TEST_F(LoadReplayTest, EventsAreFollowed) {
  for (const Controller controller : {Controller::adaptive, Controller::loop, Controller::planted}) {
    Scene scene = hurtScene(30, controller);
    scene.herds[0].sizes = {0.7f, 1};
    scene.events = {{0.2f, LoadChange{.share = 0.5f, .load = kBehind}},
                    {0.6f, LegChange{.leg = "L3"}},
                    {0.9f, LoadChange{.load = {.mass = 0.4f, .offset = {0.5f, 0.3f, 0.2f}}}},
                    {1.4f, LoadChange{.agents = {3, 4, 20}}}};
    Crowd crowd(device(), smallRollingGround(), scene, kAllWatched);
    expectFollowed(device(), crowd, scene, 110);
    EXPECT_EQ(crowd.carried(crowd.agentId(0, 3)), Load{});
    EXPECT_EQ(crowd.carried(crowd.agentId(0, 5)).mass, 0.4f);
  }
}

// Who may fall carries, too.
TEST_F(LoadReplayTest, HerdsWithReactionsCarry) {
  Scene scene = sceneOf(24);
  scene.herds[0].reactions = true;
  scene.events = {{0.2f, LoadChange{.share = 0.5f, .load = kBehind}}, {0.5f, Push{.velocity = {3, 1}}}};
  Crowd crowd(device(), smallRollingGround(), scene, kAllWatched);
  expectFollowed(device(), crowd, scene, 110);
}

// Food between two places that are near to each other, so that many carry some home in a short while.
Scene colonyScene(const Load& load) {
  Scene scene = hurtScene(30);
  scene.herds[0].goal.speed = 2;
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 0.7f};
  scene.herds[0].forage = Forage{.nest = {.centre = {0, 0}, .radius = 2},
                                 .food = {{.centre = {0, 5}, .radius = 3, .amount = 1000}},
                                 .cell = 1,
                                 .rest = 0.5f,
                                 .load = load};
  return scene;
}
bool isLaden(const HerdState& state, size_t agent) {
  const auto packed = static_cast<int>(state.forager[agent * 4 * shared::FORAGER_STRIDE + 3]);
  return packed % shared::FORAGE_STATES == shared::FORAGE_LADEN;
}

TEST_F(LoadReplayTest, ForagersCarryWhatTheyFind) {
  const Load food{.mass = 0.5f, .offset = {0, 0, 0.4f}};
  const Scene scene = colonyScene(food);
  Crowd crowd(device(), smallRollingGround(), scene, kAllWatched);
  validation::Lockstep lockstep(crowd, scene, kTick);
  std::set<uint32_t> carried, laidDown;
  constexpr int ticks = 600, look = 15;  // a look each quarter of a second
  for (int i = 0; i < ticks; ++i) {
    const HerdState before = crowd.download(0);
    lockstep.begin();
    simulate(device(), crowd, 1);
    lockstep.end();
    if (i % look != 0) continue;
    const HerdState after = crowd.download(0);
    for (uint32_t agent = 0; agent < 30; ++agent) {
      const bool laden = isLaden(before, agent);
      EXPECT_EQ(crowd.carried(crowd.agentId(0, agent)), laden ? food : Load{}) << agent;
      EXPECT_EQ(recordOf(after, Record::carried, agent)[3], laden ? 0.5f : 0) << agent;
      if (laden) carried.insert(agent);
      if (!laden && carried.contains(agent)) laidDown.insert(agent);
    }
  }
  expectAllPass(lockstep.results());
  EXPECT_GT(carried.size(), 3u);
  EXPECT_GT(laidDown.size(), 1u);
  EXPECT_GT(crowd.foraging(0).brought, 0u);
}

TEST_F(LoadGaitTest, AColonyGoesOnFromAState) {
  const Heightfield ground = smallRollingGround();
  Crowd crowd(device(), ground, colonyScene({.mass = 2}));
  simulate(device(), crowd, 415);
  Crowd again(device(), parseState(crowd.saveToMemory(), "colony.state"));
  uint32_t laden = 0;
  for (uint32_t agent = 0; agent < 30; ++agent) {
    laden += crowd.carried(crowd.agentId(0, agent)).mass > 0;
    EXPECT_EQ(again.carried(again.agentId(0, agent)), crowd.carried(crowd.agentId(0, agent)));
  }
  EXPECT_GT(laden, 3u);
  for (Crowd* each : {&crowd, &again}) simulate(device(), *each, 100);
  EXPECT_EQ(crowd.stateHash(), again.stateHash());
}

TEST_F(LoadInputTest, WhoForagesWithALoadCanBeHurt) {
  Scene scene = colonyScene({.mass = 1});
  scene.herds[0].hurt = false;
  EXPECT_EQ(inputFault([&] { Crowd(device(), flatGround(), scene); }),
            scene.name + ": herds[0]: hurt is false, expected true where agents carry");
  scene = colonyScene({.mass = 7});
  EXPECT_EQ(inputFault([&] { Crowd(device(), flatGround(), scene); }),
            scene.name + ": herds[0].forage: load.mass is 7 of the agent's mass, expected 0 to 4");
}

TEST_F(LoadInputTest, NamesWhatIsWrong) {
  Scene scene = hurtScene(5);
  scene.herds.push_back(scene.herds[0]);
  scene.herds[1].hurt = false;
  Crowd crowd(device(), rollingGround(), scene);
  const uint64_t hash = crowd.stateHash();
  const AgentId agent = crowd.agentId(0, 2);
  EXPECT_EQ(inputFault([&] { crowd.carry(crowd.agentId(1, 2), kBehind); }),
            "herd 1, agent 2: hurt is false, expected true where agents carry");
  EXPECT_EQ(inputFault([&] { crowd.carry(agent, {.mass = 4.5f}); }),
            "herd 0, agent 2: load.mass is 4.5 of the agent's mass, expected 0 to 4");
  EXPECT_EQ(inputFault([&] { crowd.carry(agent, {.mass = -1}); }),
            "herd 0, agent 2: load.mass is -1 of the agent's mass, expected 0 to 4");
  EXPECT_THAT(inputFault([&] { crowd.carry(agent, {.mass = NAN}); }),
              ::testing::HasSubstr("load.mass is nan"));
  EXPECT_EQ(inputFault([&] {
              crowd.carry(agent, {.mass = 1, .offset = {0, 0, -3}});
            }),
            "herd 0, agent 2: load.offset z is -3 leg lengths, expected -2 to 2");
  EXPECT_THAT(inputFault([&] { crowd.carry(AgentId(0, 7), kBehind); }), ::testing::HasSubstr("nobody"));
  EXPECT_THAT(inputFault([&] { crowd.carried(AgentId(0, 7)); }), ::testing::HasSubstr("nobody"));
  const std::vector<AgentLoad> half{{crowd.agentId(0, 1), kBehind}, {agent, {.mass = 9}}};
  EXPECT_NE(inputFault([&] { crowd.carry(half); }), "");
  EXPECT_EQ(crowd.carried(crowd.agentId(0, 1)), Load{});
  EXPECT_EQ(crowd.carried(crowd.agentId(1, 1)), Load{});
  EXPECT_EQ(crowd.stateHash(), hash);
}

TEST_F(LoadInputTest, EventsLoadWhomTheyName) {
  Scene scene = hurtScene(200);
  scene.events = {{0.1f, LoadChange{.agents = {3, 7}, .load = kBehind}},
                  {0.2f, LoadChange{.share = 0.3f, .load = {.mass = 2}}}};
  Crowd crowd(device(), rollingGround(), scene), twice(device(), rollingGround(), scene);
  for (Crowd* each : {&crowd, &twice}) simulate(device(), *each, 8);
  EXPECT_EQ(crowd.carried(crowd.agentId(0, 3)), kBehind);
  EXPECT_EQ(crowd.carried(crowd.agentId(0, 7)), kBehind);
  EXPECT_EQ(crowd.carried(crowd.agentId(0, 4)), Load{});
  for (Crowd* each : {&crowd, &twice}) simulate(device(), *each, 22);
  uint32_t drawn = 0;
  for (uint32_t agent = 0; agent < 200; ++agent) drawn += crowd.carried(crowd.agentId(0, agent)).mass == 2;
  // Within four standard deviations of 60, each sqrt(200 * 0.3 * 0.7).
  EXPECT_NEAR(drawn, 60, 26);
  EXPECT_EQ(crowd.stateHash(), twice.stateHash());
  const auto faultWith = [&](const LoadChange& change) {
    scene.events = {{0, change}};
    return inputFault([&] { Crowd(device(), rollingGround(), scene); });
  };
  const std::string event = scene.name + ": events[0]";
  EXPECT_EQ(faultWith({.load = {.mass = 5}}),
            event + ": load.mass is 5 of the agent's mass, expected 0 to 4");
  EXPECT_EQ(faultWith({.agents = {200}, .load = kBehind}),
            event + ".agents[0] is 200, expected less than 200, the places of its herd");
  scene.herds[0].hurt = false;
  EXPECT_EQ(faultWith({.load = kBehind}),
            event + ": herd 0: hurt is false, expected true where agents carry");
}

}  // namespace
}  // namespace skitter::test

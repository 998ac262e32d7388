// Herds whose legs can be hurt: what legs that do not carry no longer do, and how their agents go on.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "assets/files.h"
#include "cpu_reference/stages/measure.h"
#include "crowd/changes.h"
#include "crowd/follow.h"
#include "crowd/herd.h"
#include "crowd/simulation.h"
#include "skitter/error.h"
#include "skitter/state.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

class HurtTest : public GpuTest, public ::testing::WithParamInterface<Controller> {};
using HurtGaitTest = GpuTest;
using HurtReplayTest = GpuTest;
using HurtInputTest = GpuTest;

uint32_t legNamed(const Crowd& crowd, const char* name) {
  const std::vector<Leg>& legs = crowd.rig(0).legs;
  return static_cast<uint32_t>(std::ranges::find(legs, name, &Leg::name) - legs.begin());
}

std::vector<float> recordsOf(const HerdState& state, Record record, size_t first, size_t count, size_t all) {
  const std::vector<float>& from = state.of(record);
  const size_t each = from.size() / all;
  return {from.begin() + static_cast<ptrdiff_t>(first * each),
          from.begin() + static_cast<ptrdiff_t>((first + count) * each)};
}

// An agent's stability margin, from the feet that stand.
double marginOf(const HerdState& state, size_t agent, size_t legs, double bodyHeight) {
  std::vector<glm::dvec2> feet;
  for (size_t leg = agent * legs; leg < (agent + 1) * legs; ++leg)
    if (plantedOf(state, leg)) feet.emplace_back(state.tip[4 * leg], state.tip[4 * leg + 2]);
  const glm::dvec3 centre = validation::bodyOf(state, agent).orientation * glm::dvec3(0, bodyHeight, 0);
  return feet.empty() ? -1 : reference::stabilityMargin(feet, {centre.x, centre.z});
}

TEST_P(HurtTest, ALegThatIsLostIsNeitherSolvedNorCountedNorDrawn) {
  Crowd crowd(device(), rollingGround(), hurtScene(12, GetParam()), kAllWatched);
  simulate(device(), crowd, 30);
  const uint32_t leg = legNamed(crowd, "R2"), legs = 8;
  const HerdState before = crowd.download(0);
  crowd.hurt(crowd.agentId(0, 5), leg, LegState::lost, 2);
  simulate(device(), crowd, 60);
  const HerdState after = crowd.download(0);
  const size_t at = 5 * legs + leg;
  const auto chainOf = [&](const HerdState& state, size_t of) {
    return recordsOf(state, Record::chain, of, 1, 12 * legs);
  };
  EXPECT_EQ(chainOf(before, at), chainOf(after, at));
  EXPECT_NE(chainOf(before, at + legs), chainOf(after, at + legs));
  EXPECT_FALSE(plantedOf(after, at));
  EXPECT_EQ(after.metric[4 * (shared::METRIC_STRIDE * 5 + 3) + 3], 60);
  EXPECT_EQ(after.metric[4 * (shared::METRIC_STRIDE * 4 + 3) + 3], 0);
  for (const Footfall& footfall : after.footfalls) EXPECT_FALSE(footfall.agent == 5 && footfall.leg == leg);
  EXPECT_EQ(crowd.legState(crowd.agentId(0, 5), leg), LegState::lost);
  if (GetParam() == Controller::planted) return;  // its poses are matrices: the replay looks at them
  const auto bone = [&](size_t b) { return validation::boneOf(after, 5 * (1 + legs * 4) + 1 + leg * 4 + b); };
  EXPECT_FALSE(bone(1).lost);
  EXPECT_TRUE(bone(2).lost);
  EXPECT_TRUE(bone(3).lost);
  EXPECT_EQ(bone(2).position, bone(3).position);
  EXPECT_NEAR(glm::distance(bone(1).position, bone(2).position),
              double{crowd.rig(0).legs[leg].bones[1].length}, 1e-5);
}

// The same records but for what the others of its herd are.
TEST_P(HurtTest, OthersDoNotNotice) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device(), ground, hurtScene(24, GetParam()), kAllWatched),
      same(device(), ground, hurtScene(24, GetParam()), kAllWatched);
  for (Crowd* each : {&crowd, &same}) simulate(device(), *each, 20);
  crowd.hurt(crowd.agentId(0, 9), 3);
  crowd.hurt(crowd.agentId(0, 10), 2, LegState::lame);
  for (Crowd* each : {&crowd, &same}) simulate(device(), *each, 40);
  const HerdState ours = crowd.download(0), theirs = same.download(0);
  for (const size_t agent : {size_t{0}, size_t{8}, size_t{11}, size_t{23}})
    for (const Record record : {Record::body, Record::gait, Record::pose, Record::metric, Record::hurt})
      EXPECT_EQ(recordsOf(ours, record, agent, 1, 24), recordsOf(theirs, record, agent, 1, 24)) << agent;
  EXPECT_NE(recordsOf(ours, Record::pose, 9, 1, 24), recordsOf(theirs, Record::pose, 9, 1, 24));
  EXPECT_NE(crowd.stateHash(), same.stateHash());
}

TEST_P(HurtTest, WhoCannotBeHurtHasNoRecord) {
  const Heightfield ground = rollingGround();
  Scene scene = hurtScene(10, GetParam());
  scene.herds.push_back(scene.herds[0]);
  scene.herds[1].hurt = false;
  Scene alone = scene;
  alone.herds[0].hurt = false;
  Crowd crowd(device(), ground, scene, kAllWatched), plain(device(), ground, alone, kAllWatched);
  for (Crowd* each : {&crowd, &plain}) simulate(device(), *each, 10);
  crowd.hurt(crowd.agentId(0, 3), 1);
  for (Crowd* each : {&crowd, &plain}) simulate(device(), *each, 30);
  EXPECT_EQ(crowd.buffers(0, Record::hurt).size(), 1u);
  EXPECT_TRUE(crowd.buffers(1, Record::hurt).empty());
  const HerdState ours = crowd.download(1), theirs = plain.download(1);
  for (const Record record : allRecords) {
    if (record == Record::watch) continue;
    EXPECT_TRUE(sameBits(ours.of(record), theirs.of(record))) << static_cast<int>(record);
  }
  uint64_t more = 0;
  for (const MemoryUse& use : crowd.memoryUse(0))
    if (use.name == "hurt") more = use.bytes;
  EXPECT_EQ(more, 10u * 16 * shared::hurtStride(8));
}

// All states of legs, at once and one after the other, on both ways.
TEST_P(HurtTest, LegsThatHealAreUsedAgain) {
  const Heightfield ground = flatGround();
  Crowd crowd(device(), ground, hurtScene(8, GetParam()), kAllWatched);
  simulate(device(), crowd, 20);
  std::vector<AgentLeg> legs;
  for (uint32_t agent = 0; agent < 8; ++agent) {
    legs.push_back({crowd.agentId(0, agent), agent, LegState::lost, {}});
    legs.push_back({crowd.agentId(0, agent), (agent + 3) % 8, LegState::stuck, {}});
    legs.push_back({crowd.agentId(0, agent), (agent + 5) % 8, LegState::lame, {}});
  }
  crowd.hurt(legs);
  simulate(device(), crowd, 120);
  const HerdState hurt = crowd.download(0);
  for (size_t agent = 0; agent < 8; ++agent) {
    EXPECT_FALSE(plantedOf(hurt, agent * 8 + agent)) << agent;
    EXPECT_FALSE(plantedOf(hurt, agent * 8 + (agent + 3) % 8)) << agent;
  }
  for (uint32_t agent = 0; agent < 8; ++agent) crowd.heal(crowd.agentId(0, agent));
  std::vector<uint32_t> stood(64);
  for (int i = 0; i < 120; ++i) {
    simulate(device(), crowd, 1);
    const HerdState state = crowd.download(0);
    for (size_t leg = 0; leg < 64; ++leg) stood[leg] += plantedOf(state, leg);
  }
  for (size_t leg = 0; leg < 64; ++leg) EXPECT_GT(stood[leg], 20u) << leg;
  EXPECT_EQ(crowd.legState(crowd.agentId(0, 0), 0), LegState::whole);
}

TEST_P(HurtTest, AStateHasItsLegs) {
  const Heightfield ground = rollingGround();
  Scene scene = hurtScene(14, GetParam());
  scene.herds[0].reserve = 4;
  Crowd crowd(device(), ground, scene, kAllWatched);
  simulate(device(), crowd, 20);
  crowd.hurt(crowd.agentId(0, 3), 1, LegState::lost, 3);
  crowd.hurt(crowd.agentId(0, 4), 2, LegState::stuck);
  simulate(device(), crowd, 20);
  crowd.hurt(crowd.agentId(0, 3), 5, LegState::lame);  // waits for the next tick
  crowd.heal(crowd.agentId(0, 4));
  const State state = parseState(crowd.saveToMemory(), "hurt.state");
  Crowd again(device(), state);
  for (Crowd* each : {&crowd, &again}) {
    EXPECT_EQ(each->legState(each->agentId(0, 3), 1), LegState::lost);
    EXPECT_EQ(each->legState(each->agentId(0, 3), 5), LegState::lame);
    EXPECT_EQ(each->legState(each->agentId(0, 4), 2), LegState::whole);
    simulate(device(), *each, 20);
    each->hurt(each->agentId(0, 3), 2);  // the pattern is of all that was said
    simulate(device(), *each, 20);
  }
  EXPECT_EQ(crowd.stateHash(), again.stateHash());
}

TEST_P(HurtTest, TeleportKeepsDamageAndNewcomersAreWhole) {
  Scene scene = hurtScene(6, GetParam());
  scene.herds[0].reserve = 1;
  Crowd crowd(device(), rollingGround(), scene, kAllWatched);
  simulate(device(), crowd, 10);
  const AgentId agent = crowd.agentId(0, 2);
  crowd.hurt(agent, 4);
  simulate(device(), crowd, 10);
  crowd.teleport(agent, {{3, 4}, 1});
  simulate(device(), crowd, 10);
  EXPECT_EQ(validation::hurtOf(crowd.download(0), 2, 8).lost, 1u << 4);
  EXPECT_EQ(crowd.legState(agent, 4), LegState::lost);
  crowd.remove(agent);
  simulate(device(), crowd, 1);
  const AgentId born = crowd.add(0, {{1, 1}, 0});
  EXPECT_EQ(born.agent(), 2u);
  EXPECT_EQ(crowd.legState(born, 4), LegState::whole);
  simulate(device(), crowd, 1);
  EXPECT_EQ(validation::hurtOf(crowd.download(0), 2, 8).lost, 0u);
}

TEST_P(HurtTest, WhoSleepsWakes) {
  Scene scene = hurtScene(6, GetParam());
  scene.herds[0].goal.kind = Goal::Kind::none;
  CrowdOptions options = kAllWatched;
  options.sleep = true;
  Crowd crowd(device(), flatGround(), scene, options);
  simulate(device(), crowd, 300);
  ASSERT_EQ(crowd.sleeping(), 6u);
  crowd.hurt(crowd.agentId(0, 1), 3);
  simulate(device(), crowd, 1);
  EXPECT_EQ(crowd.sleeping(), 5u);
}

TEST_P(HurtTest, PagesAndFusionDoNotShow) {
  const auto hashOf = [&](const CrowdOptions& options) {
    Crowd crowd(device(), rollingGround(), hurtScene(40, GetParam()), options);
    simulate(device(), crowd, 10);
    for (uint32_t agent = 0; agent < 40; agent += 3)
      crowd.hurt(crowd.agentId(0, agent), agent % 8, allLegStates[1 + agent % 3]);
    simulate(device(), crowd, 40);
    return crowd.stateHash();
  };
  const uint64_t whole = hashOf({});
  EXPECT_EQ(whole, hashOf({}));
  EXPECT_EQ(whole, hashOf({.pageAgents = 7}));
  EXPECT_EQ(whole, hashOf({.fuse = false}));
  EXPECT_EQ(whole, hashOf(kAllWatched));
}

INSTANTIATE_TEST_SUITE_P(, HurtTest,
                         ::testing::Values(Controller::adaptive, Controller::loop, Controller::planted),
                         [](const auto& param) { return testNameOf(param.param); });

// docs/damage.md: with six legs left or more a spider is stable, and keeps its speed.
TEST_F(HurtGaitTest, ASpiderWithoutTwoLegsIsNeverAboutToFall) {
  constexpr size_t agents = 28, legs = 8;
  Scene scene = hurtScene(agents);
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 2};
  scene.herds[0].goal = {.kind = Goal::Kind::velocity, .velocity = {0, 1}};
  Crowd crowd(device(), flatGround(), scene, kAllWatched);
  simulate(device(), crowd, 60);
  uint32_t agent = 0;
  std::vector<AgentLeg> lost;
  for (uint32_t a = 0; a < legs; ++a)
    for (uint32_t b = 0; b < a; ++b, ++agent)
      for (const uint32_t leg : {a, b}) lost.push_back({crowd.agentId(0, agent), leg, LegState::lost, {}});
  ASSERT_EQ(agent, agents);
  crowd.hurt(lost);
  simulate(device(), crowd, 120);
  const HerdState before = crowd.download(0);
  std::vector<uint32_t> unstable(agents);
  constexpr int ticks = 240;
  for (int i = 0; i < ticks; ++i) {
    simulate(device(), crowd, 1);
    const HerdState state = crowd.download(0);
    for (size_t a = 0; a < agents; ++a)
      unstable[a] += marginOf(state, a, legs, double{crowd.rig(0).bodyHeight}) < 0;
  }
  const HerdState after = crowd.download(0);
  std::vector<double> speeds;
  for (size_t a = 0; a < agents; ++a) {
    speeds.push_back((positionOf(after, a).z - positionOf(before, a).z) / (ticks * double{kTick}));
    EXPECT_EQ(unstable[a], 0u) << "pair " << a << " at " << speeds[a] << " m/s";
  }
  std::ranges::sort(speeds);
  EXPECT_GT(speeds[agents / 2], 0.75);
}

void expectEventsFollowed(Device& device, const Heightfield& ground, const Scene& scene, int ticks) {
  Crowd crowd(device, ground, scene, kAllWatched);
  expectFollowed(device, crowd, scene, ticks);
}

Event hurtAll(float at, const char* leg, LegState state = LegState::lost) {
  return {at, LegChange{.leg = leg, .state = state}};
}

TEST_F(HurtReplayTest, ForagersAndThoseWhoAvoidLoseLegs) {
  Scene scene = hurtScene(30);
  scene.obstacles = {{Capsule{.from = {-4, -2}, .to = {-4, 3}, .radius = 0.3f}}};
  scene.herds[0].avoid = true;
  scene.herds[0].goal.speed = 2;
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 0.7f, .centre = {0, -4}};
  scene.herds[0].forage = Forage{.nest = {.centre = {0, -4}, .radius = 1.5f},
                                 .food = {{.centre = {0, 3}, .radius = 3, .amount = 1000}},
                                 .cell = 1,
                                 .rest = 0.5f};
  scene.events = {hurtAll(0.2f, "L1"), hurtAll(0.6f, "R2", LegState::stuck), hurtAll(1.2f, "L3"),
                  hurtAll(1.8f, "L1", LegState::whole)};
  // Obstacles change nothing, but an edit gives the reference a new ground to forage on.
  scene.events.insert(scene.events.begin() + 2, {0.8f, Mound{.centre = {3, 0}, .radius = 1, .height = 0.5f}});
  expectEventsFollowed(device(), smallRollingGround(), scene, 150);
}

// The fields are others after a threat has come, and so are those that the reference goes by.
TEST_F(HurtReplayTest, ThoseWhoFindTheirWayLoseLegs) {
  Scene scene = hurtScene(20);
  scene.herds[0].ways = Ways{};
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 1, .centre = {0, -6}};
  scene.herds[0].goal = {.kind = Goal::Kind::point, .target = {0, 8}, .speed = 2};
  scene.events = {hurtAll(0.2f, "R2"),
                  hurtAll(0.4f, "L3"),
                  {0.8f, ThreatChange{.number = 0, .threat = {.centre = {0, 2}, .radius = 2}}},
                  hurtAll(1.6f, "L4", LegState::lame)};
  expectEventsFollowed(device(), smallRollingGround(), scene, 150);
}

TEST_F(HurtGaitTest, AForagerWithoutTwoLegsCarriesFoodHome) {
  Scene scene = hurtScene(12);
  scene.herds[0].goal.speed = 2;
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 0.7f};
  scene.herds[0].forage = Forage{.nest = {.centre = {0, 0}, .radius = 2},
                                 .food = {{.centre = {0, 5}, .radius = 3, .amount = 1000}},
                                 .cell = 1,
                                 .rest = 0};
  scene.events = {hurtAll(0.1f, "R2"), hurtAll(0.1f, "L3")};
  Crowd crowd(device(), flatGround(), scene);
  simulate(device(), crowd, 1200);
  EXPECT_GT(crowd.foraging(0).brought, 0u);
}

TEST_F(HurtGaitTest, ASpiderWithoutLegsLiesOnItsBelly) {
  Scene scene = hurtScene(3);
  Crowd crowd(device(), flatGround(), scene, kAllWatched);
  simulate(device(), crowd, 60);
  for (uint32_t leg = 0; leg < 8; ++leg) {
    crowd.hurt(crowd.agentId(0, 0), leg, LegState::lost, 0);
    if (leg > 0) crowd.hurt(crowd.agentId(0, 1), leg, LegState::stuck);
  }
  simulate(device(), crowd, 240);
  const HerdState state = crowd.download(0);
  const double height = positionOf(state, 2).y;
  for (size_t agent = 0; agent < 2; ++agent) {
    EXPECT_LT(positionOf(state, agent).y, height - 0.1);
    EXPECT_EQ(validation::bodyOf(state, agent).speed, 0);
    for (const float value : recordsOf(state, Record::pose, agent, 1, 3)) EXPECT_TRUE(std::isfinite(value));
  }
}

// With every controller that can be hurt: nothing is divided by legs that are not there. The quadruped has no
// clips for planted feet.
TEST_F(HurtGaitTest, WhoHasNoLegsLiesStill) {
  for (const Controller controller : {Controller::adaptive, Controller::loop, Controller::planted}) {
    Scene scene = hurtScene(4, controller);
    const bool spider = controller == Controller::planted;
    if (!spider) scene.herds[0].rig = SKITTER_ROOT "/assets/quadruped.glb";
    const uint32_t legs = spider ? 8 : 4;
    Crowd crowd(device(), rollingGround(), scene, kAllWatched);
    simulate(device(), crowd, 60);
    // Agent 0 loses none, and the others one, all but one, and all.
    for (uint32_t leg = 0; leg < legs; ++leg) {
      if (leg < 1) crowd.hurt(crowd.agentId(0, 1), leg);
      if (leg < legs - 1) crowd.hurt(crowd.agentId(0, 2), leg);
      crowd.hurt(crowd.agentId(0, 3), leg);
    }
    simulate(device(), crowd, 180);
    const HerdState before = crowd.download(0);
    simulate(device(), crowd, 60);
    const HerdState state = crowd.download(0);
    for (const Record record :
         {Record::body, Record::gait, Record::step, Record::chain, Record::pose, Record::tip, Record::metric})
      for (const float value : state.of(record)) ASSERT_TRUE(std::isfinite(value)) << nameOf(controller);
    for (size_t agent = 0; agent < 4; ++agent) {
      const double way = glm::distance(positionOf(before, agent), positionOf(state, agent));
      if (agent < 2) {
        EXPECT_GT(way, 0.1) << nameOf(controller) << ", agent " << agent;
      } else {
        EXPECT_LT(way, 0.02) << nameOf(controller) << ", agent " << agent;
      }
    }
  }
}

TEST_F(HurtInputTest, NamesWhatIsWrong) {
  Scene scene = hurtScene(5);
  scene.herds.push_back(scene.herds[0]);
  scene.herds[1].hurt = false;
  Crowd crowd(device(), rollingGround(), scene);
  const uint64_t hash = crowd.stateHash();
  EXPECT_EQ(inputFault([&] { crowd.hurt(crowd.agentId(1, 2), 0); }),
            "herd 1, agent 2: hurt is false, expected a herd whose legs can be hurt");
  EXPECT_EQ(inputFault([&] { crowd.hurt(crowd.agentId(0, 2), 8); }),
            "herd 0, agent 2: leg is 8, expected less than 8, the legs of " + crowd.rig(0).name);
  EXPECT_EQ(inputFault([&] { crowd.hurt(crowd.agentId(0, 2), 0, LegState::lost, 4); }),
            "herd 0, agent 2: bone is 4, expected less than 4, the bones of leg L1");
  EXPECT_THAT(inputFault([&] { crowd.hurt(AgentId(0, 7), 0); }), ::testing::HasSubstr("nobody"));
  const std::vector<AgentLeg> half{{crowd.agentId(0, 1), 1}, {crowd.agentId(0, 1), 9}};
  EXPECT_NE(inputFault([&] { crowd.hurt(half); }), "");
  EXPECT_EQ(crowd.legState(crowd.agentId(0, 1), 1), LegState::whole);
  EXPECT_EQ(crowd.stateHash(), hash);
  EXPECT_EQ(
      inputFault([&] {
        scene.herds[0].controller = Controller::clip;
        Crowd(device(), rollingGround(), scene);
      }),
      scene.name + ": herds[0].controller is clip, expected adaptive, loop or planted: its legs can be hurt");
  EXPECT_EQ(inputFault([&] {
              scene.herds[0].controller = Controller::adaptive;
              scene.herds[0].solver = Solver::fabrik;
              Crowd(device(), rollingGround(), scene);
            }),
            scene.name + ": herds[0].solver is fabrik, expected active-set: its legs can be hurt");
}

TEST_F(HurtInputTest, EventsHurtWhomTheyName) {
  Scene scene = hurtScene(200);
  scene.events = {{0.1f, LegChange{.agents = {3, 7}, .leg = "R2"}},
                  {0.2f, LegChange{.share = 0.3f, .leg = "L3", .state = LegState::stuck}},
                  {0.3f, LegChange{.leg = "L1", .state = LegState::lame}}};
  Crowd crowd(device(), rollingGround(), scene), twice(device(), rollingGround(), scene);
  const auto count = [&](const char* leg, LegState state) {
    uint32_t found = 0;
    for (uint32_t agent = 0; agent < 200; ++agent)
      found += crowd.legState(crowd.agentId(0, agent), legNamed(crowd, leg)) == state;
    return found;
  };
  for (Crowd* each : {&crowd, &twice}) simulate(device(), *each, 30);
  EXPECT_EQ(count("R2", LegState::lost), 2u);
  EXPECT_EQ(count("L1", LegState::lame), 200u);
  // Within four standard deviations of 60, each sqrt(200 * 0.3 * 0.7).
  EXPECT_NEAR(count("L3", LegState::stuck), 60, 26);
  EXPECT_EQ(crowd.stateHash(), twice.stateHash());
  const auto faultWith = [&](const LegChange& change) {
    scene.events = {{0, change}};
    return inputFault([&] { Crowd(device(), rollingGround(), scene); });
  };
  const std::string event = scene.name + ": events[0]";
  EXPECT_THAT(faultWith({.leg = "R5"}), ::testing::StartsWith(event + ": " + spiderRig().name +
                                                              " has no leg \"R5\", expected one of \"L1\""));
  EXPECT_EQ(faultWith({.leg = "R1", .bone = 4}),
            event + ": bone is 4, expected less than 4, the bones of leg R1");
  scene.herds[0].hurt = false;
  EXPECT_EQ(faultWith({.leg = "R1"}),
            event + ": herd 0: hurt is false, expected a herd whose legs can be hurt");
}

// assets/scenes/lost-legs.json.
TEST_F(HurtInputTest, ExampleRuns) {
  const Scene scene = loadScene(SKITTER_ROOT "/assets/scenes/lost-legs.json");
  Crowd crowd(device(), scene.loadTerrain(), scene);
  simulate(device(), crowd, 240);
  for (uint32_t agent = 0; agent < 20; ++agent)
    for (const char* leg : {"R2", "L3"})
      EXPECT_EQ(crowd.legState(crowd.agentId(0, agent), legNamed(crowd, leg)), LegState::lost);
  simulate(device(), crowd, 60);
  EXPECT_LT(crowd.fidelity(0).penetration, 0.01);
  EXPECT_LT(crowd.fidelity(0).slip, 0.01);
}

}  // namespace
}  // namespace skitter::test

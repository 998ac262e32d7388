// Agents and herds that come and go while a crowd runs.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "crowd/herd.h"
#include "crowd/simulation.h"
#include "crowd/spawn.h"
#include "skitter/error.h"
#include "skitter/state.h"
#include "validation/convert.h"
#include "validation/herd_facts.h"

namespace skitter::test {
namespace {

using testing::HasSubstr, testing::ThrowsMessage;
using ComeAndGoInputTest = GpuTest;
class ComeAndGoTest : public GpuTest, public ::testing::WithParamInterface<Controller> {};

Scene withReserve(uint32_t agents, uint32_t reserve, Controller controller = Controller::adaptive) {
  Scene scene = sceneOf(agents, 1, 1, controller);
  scene.herds[0].reserve = reserve;
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 2};
  scene.herds[0].goal = {.kind = Goal::Kind::point, .target = {3, 4}};
  return scene;
}

// Of agent i of one state and agent j of another, of the same herd but for its number of agents.
bool sameRecords(const HerdState& a, size_t i, const HerdState& b, size_t j) {
  return std::ranges::all_of(allRecords, [&](Record record) {
    if (record == Record::watch || record == Record::metric) return true;
    const std::vector<float>&x = a.of(record), &y = b.of(record);
    const size_t each = x.size() / a.agents;
    return each == y.size() / b.agents && std::equal(x.begin() + static_cast<ptrdiff_t>(i * each),
                                                     x.begin() + static_cast<ptrdiff_t>((i + 1) * each),
                                                     y.begin() + static_cast<ptrdiff_t>(j * each));
  });
}

TEST_P(ComeAndGoTest, AReserveThatNobodyUsesShowsNowhere) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device(), ground, withReserve(21, 30, GetParam()), kAllWatched);
  Crowd plain(device(), ground, withReserve(21, 0, GetParam()), kAllWatched);
  for (Crowd* each : {&crowd, &plain}) simulate(device(), *each, 60);
  const HerdState ours = crowd.download(0), theirs = plain.download(0);
  ASSERT_EQ(ours.agents, 51u);
  for (size_t i = 0; i < 21; ++i) EXPECT_TRUE(sameRecords(ours, i, theirs, i)) << i;
  EXPECT_EQ(crowd.agentCount(), 21u);
  EXPECT_EQ(crowd.capacity(), 51u);
  EXPECT_EQ(crowd.fidelity().agentTicks, plain.fidelity().agentTicks);
  EXPECT_EQ(crowd.fidelity().reachErrorMost, plain.fidelity().reachErrorMost);
  EXPECT_EQ(crowd.fidelity().penetration, plain.fidelity().penetration);
}

// Before the first tick, to where another crowd's agents begin.
TEST_P(ComeAndGoTest, WhoComesIsAsIfItHadBegunThere) {
  const Heightfield ground = rollingGround();
  Crowd added(device(), ground, withReserve(0, 37, GetParam()), kAllWatched);
  Crowd began(device(), ground, withReserve(37, 0, GetParam()), kAllWatched);
  const Herd& herd = implOf(began).herds[0].from;
  const crowd::Spawner spawner(herd, implOf(began).kindOf(0), ground, 1);
  for (uint32_t i = 0; i < 37; ++i) {
    const auto start = spawner.place(i);
    EXPECT_EQ(added.add(0, {{start.x, start.z}, start.heading}), AgentId(0, i, 2));
  }
  for (int tick = 0; tick < 3; ++tick) {
    for (Crowd* crowd : {&added, &began}) simulate(device(), *crowd, 1);
    SCOPED_TRACE(tick);
    expectBeganAlike(added, began);
  }
}

TEST_P(ComeAndGoTest, TheReferenceFollows) {
  Crowd crowd(device(), rollingGround(), withReserve(20, 12, GetParam()), kAllWatched);
  simulate(device(), crowd, 30);
  validation::Replay replay(validation::herdFacts(implOf(crowd).kindOf(0), crowd.terrain()));
  std::vector<AgentId> here;
  for (uint32_t i = 0; i < 20; ++i) here.push_back(crowd.agentId(0, i));
  for (int tick = 0; tick < 60; ++tick) {
    if (tick % 4 == 0) {
      const auto leaver = here.begin() + tick * 7 % static_cast<int>(here.size());
      crowd.remove(*leaver);
      here.erase(leaver);
      for (int i = 0; i < tick / 8 % 3; ++i)
        here.push_back(crowd.add(0, {{static_cast<float>(tick - 20), static_cast<float>(3 * i)}, 1.0f},
                                 {.kind = Goal::Kind::velocity, .velocity = {0.5f, 0.5f}}));
      crowd::applyChanges(implOf(crowd));
    }
    const HerdState before = crowd.download(0);
    simulate(device(), crowd, 1);
    replay.tick(crowd.tick(), before, crowd.download(0));
  }
  EXPECT_EQ(crowd.agentCount(), here.size());
  expectAllPass(replay.results());
}

INSTANTIATE_TEST_SUITE_P(, ComeAndGoTest, ::testing::ValuesIn(allControllers),
                         [](const auto& param) { return testNameOf(param.param); });

TEST_F(ComeAndGoInputTest, HandlesDoNotDangle) {
  Crowd crowd(device(), flatGround(), withReserve(3, 2));
  const AgentId first = crowd.agentId(0, 1);
  EXPECT_TRUE(crowd.has(first));
  crowd.remove(first);
  EXPECT_FALSE(crowd.has(first));
  EXPECT_EQ(crowd.agentCount(), 2u);
  // The lowest empty place is taken.
  const AgentId second = crowd.add(0, {{1, 1}, 0});
  EXPECT_EQ(second.agent(), 1u);
  EXPECT_NE(second, first);
  EXPECT_EQ(crowd.add(0, {{2, 1}, 0}).agent(), 3u);
  EXPECT_EQ(crowd.add(0, {{3, 1}, 0}).agent(), 4u);
  EXPECT_THAT([&] { crowd.add(0, {}); },
              ThrowsMessage<Error>(HasSubstr("herd 0: all of its 5 places are taken")));
  const auto isNobody = ThrowsMessage<Error>(HasSubstr("herd 0, agent 1 of generation 0: nobody"));
  const AgentGoal goal{first, {}};
  const AgentSpeed speed{first, 1};
  EXPECT_THAT([&] { crowd.remove(first); }, isNobody);
  EXPECT_THAT([&] { crowd.teleport(first, {}); }, isNobody);
  EXPECT_THAT([&] { crowd.steer({&goal, 1}); }, isNobody);
  EXPECT_THAT([&] { crowd.setSpeed({&speed, 1}); }, isNobody);
  // A handle of a place that is empty.
  crowd.remove(second);
  EXPECT_FALSE(crowd.has(second));
  EXPECT_THAT([&] { crowd.agentId(0, 1); }, ThrowsMessage<Error>(HasSubstr("nobody")));
  EXPECT_FALSE(crowd.has(AgentId(0, 1, 3)));
  EXPECT_THAT(
      [&] {
        crowd.add(0, {{99, 0}, 0});
      },
      ThrowsMessage<Error>(HasSubstr("herd 0, a new agent: x is 99 m")));
  Crowd none(device(), flatGround(), withReserve(3, 0));
  EXPECT_THAT([&] { none.remove(none.agentId(0, 0)); },
              ThrowsMessage<Error>(HasSubstr("herd 0: its reserve is 0")));
  EXPECT_THAT([&] { none.add(0, {}); }, ThrowsMessage<Error>(HasSubstr("herd 0: its reserve is 0")));
}

TEST_F(ComeAndGoInputTest, WhoIsGoneDoesNothing) {
  Crowd crowd(device(), rollingGround(), withReserve(30, 1), kAllWatched);
  simulate(device(), crowd, 25);
  const uint64_t ticks = crowd.fidelity().agentTicks;
  for (uint32_t i = 0; i < 30; i += 2) crowd.remove(crowd.agentId(0, i));
  simulate(device(), crowd, 1);
  const HerdState gone = crowd.download(0);
  // Not even when the ground moves, when nobody else may sleep.
  std::vector<float> heights = crowd.terrain().heights;
  for (float& height : heights) height += 0.1f;
  crowd.editHeights(0, 0, crowd.terrain().columns, crowd.terrain().rows, heights);
  for (int i = 0; i < 40; ++i) {
    simulate(device(), crowd, 1);
    for (const Footfall& footfall : crowd.footfalls(0)) EXPECT_EQ(footfall.agent % 2, 1u);
  }
  const HerdState state = crowd.download(0);
  for (size_t i = 0; i < 30; ++i) {
    EXPECT_EQ(sameRecords(state, i, gone, i), i % 2 == 0) << i;
    EXPECT_EQ(state.body[16 * i + 7], i % 2 == 0 ? 1 : 0);
  }
  EXPECT_EQ(crowd.fidelity().agentTicks, ticks + 15 * 41);
}

TEST_F(ComeAndGoInputTest, SleepersAreThoseWhoAreThere) {
  Scene scene = withReserve(10, 20);
  scene.herds[0].goal.kind = Goal::Kind::none;
  Crowd crowd(device(), flatGround(), scene, CrowdOptions{.sleep = true});
  simulate(device(), crowd, 600);
  EXPECT_EQ(crowd.sleeping(), 10u);
  crowd.add(0, {{5, 5}, 0});
  crowd.remove(crowd.agentId(0, 0));
  EXPECT_EQ(crowd.sleeping(), 10u);
  simulate(device(), crowd, 1);
  EXPECT_EQ(crowd.sleeping(), 9u);
}

TEST_F(ComeAndGoInputTest, SleepersOfHerdsThatComeAndGoAreThoseOfTheTick) {
  Scene scene = withReserve(10, 0);
  scene.herds[0].goal.kind = Goal::Kind::none;
  Herd guests = withReserve(40, 5).herds[0];
  Crowd crowd(device(), flatGround(), scene, CrowdOptions{.sleep = true});
  simulate(device(), crowd, 600);
  EXPECT_EQ(crowd.sleeping(), 10u);
  HerdId came = crowd.addHerd(guests);
  EXPECT_EQ(crowd.sleeping(), 10u);
  EXPECT_EQ(Crowd(device(), parseState(crowd.saveToMemory(), "a state")).sleeping(), 10u);
  simulate(device(), crowd, 2);
  EXPECT_EQ(crowd.sleeping(), 10u);
  // Whoever leaves or comes before the next tick does not count.
  crowd.remove(crowd.agentId(came.index, 3));
  crowd.remove(crowd.agentId(came.index, 4));
  crowd.add(came.index, {{5, 5}, 0});
  crowd.removeHerd(came);
  EXPECT_EQ(crowd.sleeping(), 10u);
  crowd.removeHerd(crowd.addHerd(guests));
  EXPECT_EQ(crowd.sleeping(), 10u);
  simulate(device(), crowd, 1);
  EXPECT_EQ(crowd.sleeping(), 10u);
  crowd.removeHerd(crowd.herdId(0));
  EXPECT_EQ(crowd.sleeping(), 0u);
}

// Whatever the pages are.
TEST_F(ComeAndGoInputTest, TheSameCallsGiveTheSameBits) {
  const auto hash = [&](uint32_t pageAgents) {
    Crowd crowd(device(), rollingGround(), withReserve(40, 20), CrowdOptions{.pageAgents = pageAgents});
    for (uint32_t i = 0; i < 20; ++i) {
      simulate(device(), crowd, 3);
      crowd.add(0, {{static_cast<float>(i) - 10, 7}, static_cast<float>(i)});
      crowd.remove(crowd.agentId(0, 2 * i));
      crowd.teleport(crowd.agentId(0, 2 * i + 1), {{static_cast<float>(i) - 10, -7}, 0});
    }
    simulate(device(), crowd, 3);
    return crowd.stateHash();
  };
  EXPECT_EQ(hash(0), hash(16));
}

TEST_F(ComeAndGoInputTest, AHerdThatComesIsAsOneThatWasThere) {
  const Heightfield ground = rollingGround();
  Scene two = withReserve(12, 0);
  two.herds.push_back(two.herds[0]);
  two.herds[1].controller = Controller::loop;
  Scene one = two;
  one.herds.pop_back();
  Crowd there(device(), ground, two, kAllWatched), came(device(), ground, one, kAllWatched);
  const HerdId herd = came.addHerd(two.herds[1]);
  EXPECT_EQ(herd, (HerdId{1, 0}));
  for (Crowd* crowd : {&there, &came}) simulate(device(), *crowd, 20);
  EXPECT_EQ(there.stateHash(), came.stateHash());
  EXPECT_EQ(came.fidelity(1).agentTicks, 240u);

  // Gone, its number and its memory are free; the handles of its agents are of nobody.
  const uint64_t bytes = came.memoryBytes();
  const AgentId agent = came.agentId(1, 3);
  came.removeHerd(herd);
  EXPECT_FALSE(came.has(herd));
  EXPECT_FALSE(came.has(agent));
  EXPECT_EQ(came.agentCount(), 12u);
  EXPECT_LT(came.memoryBytes(), bytes);
  EXPECT_EQ(came.download(1).agents, 0u);
  EXPECT_THAT([&] { came.removeHerd(herd); },
              ThrowsMessage<Error>(HasSubstr("herd 1 of generation 0: expected")));
  const auto isRefused = ThrowsMessage<Error>(HasSubstr("herd 1: was removed"));
  EXPECT_THAT([&] { came.herdId(1); }, isRefused);
  EXPECT_THAT([&] { came.steer(1, Goal{}); }, isRefused);
  EXPECT_THAT([&] { came.steer(1, std::vector<Goal>{}); }, isRefused);
  EXPECT_THAT([&] { came.setSpeed(1, 1); }, isRefused);
  EXPECT_THAT([&] { came.setSpeed(1, std::vector<float>{}); }, isRefused);
  EXPECT_THAT([&] { came.add(1, {{0, 0}, 0}); }, isRefused);
  simulate(device(), came, 5);
  Herd third = two.herds[1];
  third.controller = Controller::adaptive;
  third.reserve = 2;
  const HerdId again = came.addHerd(third);
  EXPECT_EQ(again, (HerdId{1, 2}));
  EXPECT_FALSE(came.has(agent));
  EXPECT_TRUE(came.has(came.agentId(1, 3)));
  came.add(1, {{1, 2}, 3});
  simulate(device(), came, 20);
  EXPECT_EQ(came.agentCount(1), 13u);
  EXPECT_EQ(came.fidelity(1).agentTicks, 13u * 20);
  // Nobody jumped while it was watched.
  EXPECT_LT(came.fidelity(1).skating, 0.01);
}

TEST_F(ComeAndGoInputTest, HerdsThatCannotBeAreRefused) {
  Scene scene = withReserve(4, 0);
  scene.herds.push_back(scene.herds[0]);
  Crowd crowd(device(), flatGround(), scene);
  EXPECT_THAT([&] { crowd.removeHerd(crowd.herdId(0)); },
              ThrowsMessage<Error>(HasSubstr("herd 0: shares pages with other herds")));
  Herd herd = scene.herds[0];
  herd.agents = Scene::maxAgents;
  EXPECT_THAT([&] { crowd.addHerd(herd); },
              ThrowsMessage<Error>(HasSubstr("expected at most 16777216 in all")));
  herd.agents = 1;
  herd.rig = "nowhere.glb";
  EXPECT_THROW(crowd.addHerd(herd), Error);
  herd.rig = "spider";
  herd.tuning.stepHeight = 1e9f;
  EXPECT_THAT([&] { crowd.addHerd(herd); }, ThrowsMessage<Error>(HasSubstr("a new herd: herds[0].tuning")));
  EXPECT_EQ(crowd.herdCount(), 2u);
  // Equal herds with a reserve leave empty places behind.
  scene.herds[0].reserve = scene.herds[1].reserve = 1;
  Crowd shared(device(), flatGround(), scene);
  shared.removeHerd(shared.herdId(0));
  EXPECT_EQ(shared.agentCount(), 4u);
  simulate(device(), shared, 2);
  shared.removeHerd(shared.herdId(1));
  EXPECT_EQ(shared.agentCount(), 0u);
  simulate(device(), shared, 2);
}

}  // namespace
}  // namespace skitter::test

// Crowds that are steered while they run: goals, speeds and places, from the host and from a shader.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "crowd/herd.h"
#include "crowd/simulation.h"
#include "crowd/spawn.h"
#include "skitter/error.h"
#include "validation/convert.h"
#include "validation/herd_facts.h"

namespace skitter::test {
namespace {

using SteerTest = GpuLoadTest;
using SteerInputTest = GpuTest;
class TeleportTest : public GpuTest, public ::testing::WithParamInterface<Controller> {};

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Goal velocityOf(float x, float z) { return {.kind = Goal::Kind::velocity, .velocity = {x, z}}; }

// Two kinds, one of them of two herds, and pages that end within them.
Scene threeHerds() {
  Scene scene = sceneOf(21);
  scene.herds.resize(3, scene.herds[0]);
  scene.herds[1].agents = 30;
  scene.herds[2].controller = Controller::loop;
  for (Herd& herd : scene.herds) {
    herd.spawn = {.kind = Spawn::Kind::grid, .spacing = 2.5f};
    herd.goal.kind = Goal::Kind::none;
  }
  return scene;
}
const CrowdOptions smallPages{.feet = true, .footfalls = UINT32_MAX, .pageAgents = 16};

// How fast an agent goes, x and z.
glm::dvec2 speedOf(const HerdState& state, size_t agent) {
  const reference::AgentBody body = validation::bodyOf(state, agent);
  return body.heading * body.speed;
}

TEST_P(SteerTest, AgentsGoByTheVelocityThatTheyAreGiven) {
  Crowd crowd(device(), flatGround(), threeHerds(), smallPages);
  simulate(device(), crowd, 10);
  // A herd at once, one goal an agent, and some.
  crowd.steer(0, velocityOf(1, 0));
  std::vector<Goal> goals;
  for (uint32_t i = 0; i < 30; ++i)
    goals.push_back(i % 2 == 0 ? velocityOf(0, 0.5f) : Goal{.kind = Goal::Kind::none});
  crowd.steer(1, goals);
  const std::vector<AgentGoal> some{{crowd.agentId(2, 20), velocityOf(-0.5f, 0.5f)}};
  crowd.steer(some);
  goals.clear();
  simulate(device(), crowd, 240);
  const auto near = [](glm::dvec2 a, glm::dvec2 b) { return glm::length(a - b) < 0.1; };
  for (uint32_t h = 0; h < 3; ++h) {
    const HerdState state = crowd.download(h);
    for (size_t i = 0; i < state.agents; ++i) {
      glm::dvec2 wanted(0);
      if (h == 0) wanted = {1, 0};
      if (h == 1 && i % 2 == 0) wanted = {0, 0.5};
      if (h == 2 && i == 20) wanted = {-0.5, 0.5};
      EXPECT_TRUE(near(speedOf(state, i), wanted)) << h << ", " << i << ": " << speedOf(state, i).x;
    }
  }
}

TEST_P(SteerTest, TheReferenceFollowsEveryChange) {
  Crowd crowd(device(), rollingGround(), sceneOf(32), CrowdOptions{.feet = true, .footfalls = UINT32_MAX});
  simulate(device(), crowd, 60);
  validation::Replay replay(validation::herdFacts(implOf(crowd).kindOf(0), crowd.terrain()));
  for (int tick = 0; tick < 100; ++tick) {
    if (tick % 10 == 0) {
      for (uint32_t agent = 0; agent < 32; ++agent) {
        const AgentId id = crowd.agentId(0, agent);
        const float way = static_cast<float>(agent + tick);
        const AgentGoal goal{id, velocityOf(std::sin(way), std::cos(way))};
        const AgentSpeed slow{id, 0.3f};
        const auto kind = (agent + tick / 10) % 4;
        if (kind != 3) crowd.steer({&goal, 1});
        if (kind == 1) crowd.setSpeed({&slow, 1});
        if (kind == 2) crowd.teleport(id, {{3 * way / 10, way - 80}, way});
      }
      crowd::applyChanges(implOf(crowd));
    }
    const HerdState before = crowd.download(0);
    simulate(device(), crowd, 1);
    replay.tick(crowd.tick(), before, crowd.download(0));
  }
  expectAllPass(replay.results());
}

INSTANTIATE_TEST_SUITE_P(, SteerTest, bothLoadPaths(), loadPathName);

TEST_F(SteerInputTest, TheGoalsThatTheyHaveShowNowhere) {
  const Scene scene = threeHerds();
  Crowd steered(device(), rollingGround(), scene, smallPages),
      plain(device(), rollingGround(), scene, smallPages);
  for (uint32_t h = 0; h < 3; ++h) {
    steered.steer(h, scene.herds[h].goal);
    steered.setSpeed(h, scene.herds[h].goal.speed);
  }
  for (Crowd* crowd : {&steered, &plain}) simulate(device(), *crowd, 20);
  EXPECT_EQ(steered.stateHash(), plain.stateHash());
}

// More agents than one update of a command buffer takes, in any order, and with more than one goal for some.
TEST_F(SteerInputTest, TheLastCallCountsAndOrderDoesNot) {
  Scene scene = sceneOf(2500, 1, 1, Controller::loop);
  Crowd dense(device(), rollingGround(), scene),
      sparse(device(), rollingGround(), scene, CrowdOptions{.pageAgents = 600});
  std::vector<Goal> goals;
  std::vector<AgentGoal> each;
  for (uint32_t i = 0; i < 2500; ++i) {
    goals.push_back(i % 3 == 0 ? velocityOf(static_cast<float>(i) * 1e-3f, -1) : Goal{.speed = 0.5f});
    each.push_back({AgentId(0, 2499 - i), velocityOf(9, 9)});
  }
  for (uint32_t i = 0; i < 2500; ++i) each.push_back({AgentId(0, i * 7 % 2500), goals[i * 7 % 2500]});
  dense.steer(0, goals);
  sparse.steer(each);
  for (Crowd* crowd : {&dense, &sparse}) simulate(device(), *crowd, 2);
  EXPECT_EQ(dense.stateHash(), sparse.stateHash());
  std::vector<float> speeds(2500, 0.25f);
  dense.setSpeed(0, speeds);
  sparse.setSpeed(0, 0.25f);
  for (Crowd* crowd : {&dense, &sparse}) simulate(device(), *crowd, 2);
  EXPECT_EQ(dense.stateHash(), sparse.stateHash());
  const HerdState state = dense.download(0);
  for (size_t i = 0; i < 2500; ++i) {
    const float* steer = &state.steer[i * 4];
    EXPECT_LE(std::hypot(steer[0], steer[1]), 0.2501f) << i;
  }
}

TEST_F(SteerInputTest, ASleeperWakesForAGoal) {
  Scene scene = sceneOf(16);
  scene.herds[0].goal.kind = Goal::Kind::none;
  Crowd crowd(device(), flatGround(), scene, CrowdOptions{.sleep = true});
  simulate(device(), crowd, 600);
  ASSERT_EQ(crowd.sleeping(), 16u);
  const std::vector<AgentGoal> goals{{AgentId(0, 3), velocityOf(0, 1)}};
  crowd.steer(goals);
  crowd.teleport(AgentId(0, 5), {{1, 1}, 0});
  simulate(device(), crowd, 1);
  EXPECT_EQ(crowd.sleeping(), 14u);
}

// Whatever is wrong, nothing is changed.
TEST_F(SteerInputTest, RefusesWhatCannotBe) {
  using testing::HasSubstr, testing::ThrowsMessage;
  const Scene scene = threeHerds();
  Crowd crowd(device(), flatGround(), scene), plain(device(), flatGround(), scene);
  const auto refuses = [](const auto& call, const char* message) {
    EXPECT_THAT(call, ThrowsMessage<Error>(HasSubstr(message)));
  };
  refuses([&] { crowd.steer(3, Goal{}); }, "herd 3: expected one of the crowd's 3 herds");
  refuses([&] { crowd.steer(1, velocityOf(kNan, 0)); },
          "herd 1: the length of goal.velocity is nan m/s, expected 0 to 1000");
  refuses([&] { crowd.steer(1, velocityOf(900, 900)); }, "1272.79 m/s, expected 0 to 1000");
  refuses([&] { crowd.steer(1, Goal{.speed = -1}); }, "herd 1: goal.speed is -1 m/s, expected 0 to 1000");
  refuses(
      [&] {
        crowd.steer(1, Goal{.kind = Goal::Kind::point, .target = {0, 5000}});
      },
      "herd 1: goal.target z is 5000 m, expected -4096 to 4096");
  std::vector<Goal> goals(30);
  refuses([&] { crowd.steer(0, goals); }, "herd 0: found 30 goals, expected 21, one a place");
  goals[29] = velocityOf(0, INFINITY);
  refuses([&] { crowd.steer(1, goals); }, "herd 1, agent 29: the length of goal.velocity is inf m/s");
  const std::vector<AgentGoal> some{{AgentId(0, 1), velocityOf(1, 1)}, {AgentId(0, 21), Goal{}}};
  refuses([&] { crowd.steer(some); }, "herd 0, agent 21 of generation 0: nobody, expected one of 21 agents");
  refuses([&] { crowd.setSpeed(0, kNan); }, "herd 0: the speed is nan m/s");
  refuses([&] { crowd.setSpeed(0, std::vector<float>(20)); }, "herd 0: found 20 speeds, expected 21");
  const std::vector<AgentPlace> places{{AgentId(0, 1), {}}, {AgentId(0, 2), {{0, kNan}, 0}}};
  refuses([&] { crowd.teleport(places); }, "herd 0, agent 2: z is nan m, expected -32 to 32");
  refuses([&] { crowd.teleport(AgentId(0, 2), {{33, 0}, 0}); }, "herd 0, agent 2: x is 33 m");
  refuses(
      [&] {
        crowd.teleport(AgentId(0, 2), {{0, 0}, kNan});
      },
      "herd 0, agent 2: the heading is nan radians");
  refuses([&] { crowd.teleport(AgentId(), {}); }, "herd 1023");
  refuses([&] { crowd.agentId(0, 21); }, "herd 0, agent 21");
  EXPECT_NO_THROW(crowd.steer(std::span<const AgentGoal>()));
  for (Crowd* each : {&crowd, &plain}) simulate(device(), *each, 2);
  EXPECT_EQ(crowd.stateHash(), plain.stateHash());
}

TEST(AgentIds, HoldWhatTheyAreMadeOf) {
  const AgentId id(1023, (1u << 24) - 1, (1u << 30) - 2);
  EXPECT_EQ(id.herd(), 1023u);
  EXPECT_EQ(id.agent(), (1u << 24) - 1);
  EXPECT_EQ(id.generation(), (1u << 30) - 2);
  EXPECT_EQ(AgentId::ofBits(id.bits()), id);
  // Larger ones are of nobody, not of another agent.
  EXPECT_EQ(AgentId(1024, 0), AgentId());
  EXPECT_EQ(AgentId(0, 1 << 24), AgentId());
  EXPECT_EQ(AgentId(0, 0, 1 << 30), AgentId());
}

// Before the first tick, to where another crowd's agents begin.
TEST_P(TeleportTest, IsAsIfTheAgentHadBegunThere) {
  Scene here = sceneOf(37, 1, 1, GetParam()), there = here;
  here.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 2};
  there.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 3, .centre = {7, -9}, .heading = 2};
  for (Scene* scene : {&here, &there}) scene->herds[0].goal = {.kind = Goal::Kind::point, .target = {3, 4}};
  const Heightfield ground = rollingGround();
  Crowd moved(device(), ground, here, smallPages), began(device(), ground, there, smallPages);
  const crowd::Spawner spawner(there.herds[0], implOf(began).kindOf(0), ground, there.seed);
  std::vector<AgentPlace> places;
  for (uint32_t i = 0; i < 37; ++i) {
    const auto start = spawner.place(i);
    places.push_back({AgentId(0, i), {{start.x, start.z}, start.heading}});
  }
  moved.teleport(places);
  for (int i = 0; i < 3; ++i) {
    for (Crowd* crowd : {&moved, &began}) simulate(device(), *crowd, 1);
    SCOPED_TRACE(i);
    expectBeganAlike(moved, began);
  }
}

// While they run: from the next tick on every foot is where it should be, and nobody saw a jump or a
// touchdown.
TEST_P(TeleportTest, LeavesNoTraceOfTheWay) {
  Crowd crowd(device(), rollingGround(), sceneOf(40, 1, 1, GetParam()),
              CrowdOptions{.watchEvery = 1, .feet = true, .footfalls = UINT32_MAX});
  simulate(device(), crowd, 77);
  crowd.steer(0, Goal{.kind = Goal::Kind::none});
  std::vector<AgentPlace> places;
  for (uint32_t i = 0; i < 40; ++i)
    places.push_back({AgentId(0, i), {{3.0f * static_cast<float>(i) - 60, 5}, static_cast<float>(i)}});
  crowd.teleport(places);
  const Fidelity before = crowd.fidelity();
  simulate(device(), crowd, 1);
  EXPECT_TRUE(crowd.footfalls(0).empty());
  const HerdState state = crowd.download(0);
  const double leg = crowd.rig(0).legLength;
  for (size_t i = 0; i < 40; ++i) {
    EXPECT_NEAR(positionOf(state, i).x, places[i].place.position.x, 0.02 * leg);
    EXPECT_NEAR(positionOf(state, i).z, 5, 0.02 * leg);
    const float heading = std::atan2(state.body[i * 16 + 4], state.body[i * 16 + 5]);
    EXPECT_NEAR(std::remainder(heading - places[i].place.heading, 2 * M_PI), 0, 0.02);
    for (size_t l = 8 * i; l < 8 * (i + 1); ++l)
      EXPECT_LT(state.tip[4 * l + 3], 1e-3 * leg) << i << ", " << l;
  }
  simulate(device(), crowd, 50);
  const Fidelity after = crowd.fidelity();
  EXPECT_LE(after.skating, before.skating);  // standing feet add nothing
  // Bodies that lie down on the ground make 88 where they know no feet; a jump of some metres makes 4e7.
  EXPECT_LT(after.bodyJerk, 1000);
  EXPECT_EQ(after.notFinite, 0u);
}

TEST_P(TeleportTest, DoesNotTouchOthers) {
  const Scene scene = sceneOf(40, 1, 1, GetParam());
  Crowd crowd(device(), rollingGround(), scene, smallPages),
      plain(device(), rollingGround(), scene, smallPages);
  for (Crowd* each : {&crowd, &plain}) simulate(device(), *each, 50);
  crowd.teleport(AgentId(0, 17), {{9, 9}, 1});
  for (Crowd* each : {&crowd, &plain}) simulate(device(), *each, 3);
  const auto records = [](const HerdState& state, size_t agent) {
    std::vector<float> all;
    for (const Record record :
         {Record::goal, Record::body, Record::gait, Record::step, Record::chain, Record::tip}) {
      const auto& from = state.of(record);
      const auto each = static_cast<ptrdiff_t>(from.size() / state.agents),
                 first = static_cast<ptrdiff_t>(agent) * each;
      all.insert(all.end(), from.begin() + first, from.begin() + first + each);
    }
    return all;
  };
  const HerdState ours = crowd.download(0), theirs = plain.download(0);
  for (size_t i = 0; i < 40; ++i) EXPECT_EQ(records(ours, i) == records(theirs, i), i != 17) << i;
}

INSTANTIATE_TEST_SUITE_P(, TeleportTest, ::testing::ValuesIn(allControllers),
                         [](const auto& param) { return testNameOf(param.param); });

// On slopes of up to 77 degrees, where some homes are beyond what the leg's limits allow: about as near as
// those of agents that begin there.
TEST_F(SteerInputTest, OnSteepGroundFeetStandNearlyAsThoseOfAgentsThatBeginThere) {
  Scene scene = parseScene(
      R"({"terrain": {"kind": "file", "file": "everest_513x513.png", "scale": 0.005426},
          "herds": [{"agents": 1000, "goal": {"kind": "none"}}]})",
      "everest", SKITTER_ROOT "/assets/terrain");
  const Heightfield ground = scene.loadTerrain();
  const auto missesOf = [](const Crowd& crowd) {
    const HerdState state = crowd.download(0);
    std::vector<float> misses;
    for (size_t leg = 0; leg < state.tip.size() / 4; ++leg) misses.push_back(state.tip[4 * leg + 3]);
    std::ranges::sort(misses);
    return misses;
  };
  Crowd began(device(), ground, scene, CrowdOptions{.feet = true});
  const crowd::Spawner spawner(scene.herds[0], implOf(began).kindOf(0), ground, scene.seed);
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 0.5f};
  Crowd moved(device(), ground, scene, CrowdOptions{.feet = true});
  std::vector<AgentPlace> places;
  for (uint32_t i = 0; i < 1000; ++i) {
    const auto start = spawner.place(i);
    places.push_back({AgentId(0, i), {{start.x, start.z}, start.heading}});
  }
  simulate(device(), moved, 40);
  moved.teleport(places);
  for (Crowd* each : {&began, &moved}) simulate(device(), *each, 1);
  const std::vector<float> ours = missesOf(moved), theirs = missesOf(began);
  const double leg = began.rig(0).legLength;
  EXPECT_GT(theirs.back(), 0.1 * leg);  // such ground it is
  EXPECT_LT(ours.back(), 2 * theirs.back());
  const auto reached = [&](const std::vector<float>& misses) {
    return std::ranges::count_if(misses, [&](float miss) { return miss < 1e-3 * leg; });
  };
  EXPECT_GE(reached(ours), 0.99 * static_cast<double>(reached(theirs))) << "of " << ours.size() << " legs";
}

}  // namespace
}  // namespace skitter::test

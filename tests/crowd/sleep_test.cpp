// Who stands long enough sleeps (docs/stages/navigate.md): nothing of it changes until its goal or the
// ground moves, and nobody else notices.
#include <bit>
#include <cmath>
#include <set>
#include <string>
#include <tuple>

#include "crowd/herd.h"
#include "crowd/simulation.h"
#include "gpu/transfer.h"
#include "validation/herd_facts.h"

namespace skitter::test {
namespace {

CrowdOptions sleeping(uint32_t pageAgents = 0) { return {.sleep = true, .pageAgents = pageAgents}; }

Scene standing(uint32_t agents, Controller controller = Controller::adaptive) {
  Scene scene = sceneOf(agents, 1, 1, controller);
  scene.herds[0].goal.kind = Goal::Kind::none;
  return scene;
}

// They come from different ways off, so they fall asleep one after another.
Scene arriving(uint32_t agents, Controller controller = Controller::adaptive) {
  Scene scene = sceneOf(agents, 1.5f, 3, controller);
  scene.herds[0].spawn.kind = Spawn::Kind::grid;
  scene.herds[0].goal = {.kind = Goal::Kind::point, .target = {0, 2}, .speed = 1.5f};
  return scene;
}

bool sleeps(const HerdState& state, size_t agent) { return state.steer.at(4 * agent + 2) == 1; }
size_t sleepersOf(const HerdState& state) {
  size_t count = 0;
  for (size_t agent = 0; agent < state.agents; ++agent) count += sleeps(state, agent) ? 1 : 0;
  return count;
}

// Ticks after which an agent that stands still sleeps at the latest: sleepTime and a breath.
int restTicks(const Crowd& crowd, uint32_t herd = 0) {
  const HerdState state = crowd.download(herd);
  float cycle = 0;
  for (size_t agent = 0; agent < state.agents; ++agent)
    cycle = std::max(cycle, state.gait[agent * shared::GAIT_STRIDE * 4 + 5]);
  return static_cast<int>(std::ceil((implOf(crowd).kindOf(herd).parameters.sleepTime + cycle) / kTick)) + 2;
}

// Writes the goal of an agent of a herd of one page, as navigate reads it.
void wish(const gpu::Context& context, Crowd& crowd, size_t agent, float kind, const glm::dvec3& target) {
  const crowd::Page& page = implOf(crowd).kindOf(0).pages.at(0);
  std::vector<float> goals = gpu::download<float>(context, page.goal);
  float* goal = goals.data() + agent * shared::GOAL_STRIDE * 4;
  goal[0] = static_cast<float>(target.x), goal[1] = static_cast<float>(target.z);
  goal[6] = kind;
  gpu::upload(context, page.goal, goals);
}

// The whole terrain, by as much everywhere.
void raise(Crowd& crowd, float by) {
  std::vector<float> heights = crowd.terrain().heights;
  for (float& height : heights) height += by;
  crowd.editHeights(0, 0, crowd.terrain().columns, crowd.terrain().rows, heights);
}

// The records of one agent that the stages from body to pose write.
std::vector<float> recordsOf(const HerdState& state, size_t agent) {
  std::vector<float> records;
  for (const auto kind :
       {&HerdState::body, &HerdState::gait, &HerdState::step, &HerdState::foot, &HerdState::chain,
        &HerdState::pose, &HerdState::play, &HerdState::start, &HerdState::fix, &HerdState::spring}) {
    const std::vector<float>& all = state.*kind;
    const auto each = static_cast<std::ptrdiff_t>(all.size() / state.agents);
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(agent) * each;
    records.insert(records.end(), first, first + each);
  }
  return records;
}
using Case = std::tuple<LoadPath, Controller>;

class SleepTest : public GpuTest, public ::testing::WithParamInterface<Case> {
 protected:
  SleepTest() : GpuTest(std::get<0>(GetParam())) {}
  Controller controller() const { return std::get<1>(GetParam()); }
};

TEST_P(SleepTest, WhoStandsSleepsAndStaysAsItIs) {
  Crowd crowd(device(), rollingGround(), standing(20, controller()), sleeping());
  simulate(device(), crowd, 1);
  const float sleepTime = implOf(crowd).kindOf(0).parameters.sleepTime;
  ASSERT_GT(sleepTime, 0);
  while (static_cast<float>(crowd.tick() + 2) * kTick < sleepTime) simulate(device(), crowd, 1);
  EXPECT_EQ(sleepersOf(crowd.download(0)), 0u) << "too early";
  simulate(device(), crowd, restTicks(crowd));
  const HerdState state = crowd.download(0);
  EXPECT_TRUE(state.sleep);
  ASSERT_EQ(sleepersOf(state), 20u);
  const uint64_t hash = crowd.stateHash();
  const Fidelity before = crowd.fidelity();
  for (int i = 0; i < 5; ++i) {
    simulate(device(), crowd, 30);
    EXPECT_EQ(crowd.stateHash(), hash);
    EXPECT_EQ(sleepersOf(crowd.download(0)), 20u);
  }
  const HerdState after = crowd.download(0);
  for (size_t agent = 0; agent < 20; ++agent)
    EXPECT_TRUE(sameBits(recordsOf(state, agent), recordsOf(after, agent))) << "agent " << agent;
  EXPECT_EQ(crowd.fidelity().agentTicks, before.agentTicks + 20 * 150) << "measured all the same";
}

TEST_P(SleepTest, ReplayThroughFallingAsleepSleepingAndWaking) {
  const Heightfield ground = smallRollingGround();
  for (const uint32_t agents : {1u, 7u, 8u, 9u, 65u}) {
    SCOPED_TRACE(agents);
    CrowdOptions options = sleeping();
    options.footfalls = UINT32_MAX;
    Crowd crowd(device(), ground, standing(agents, controller()), options);
    simulate(device(), crowd, 1);
    validation::Replay replay(validation::herdFacts(implOf(crowd).kindOf(0), ground));
    const int rest = restTicks(crowd);
    const auto early = static_cast<int>(implOf(crowd).kindOf(0).parameters.sleepTime / kTick) - 5;
    simulate(device(), crowd, early);
    EXPECT_EQ(sleepersOf(crowd.download(0)), 0u);
    const auto compare = [&](int ticks) {
      HerdState before = crowd.download(0);
      for (int i = 0; i < ticks; ++i) {
        simulate(device(), crowd, 1);
        HerdState after = crowd.download(0);
        replay.tick(crowd.tick(), before, after);
        before = std::move(after);
      }
      return before;
    };
    const HerdState asleep = compare(rest - early + 5);
    EXPECT_EQ(sleepersOf(asleep), agents);
    size_t woken = 0;
    for (uint32_t agent = 0; agent < agents; agent += 3, ++woken) {
      const glm::dvec3 here = positionOf(asleep, agent);
      const float kind = agent % 2 == 0 ? shared::GOAL_CROSS : shared::GOAL_POINT;
      wish(context(), crowd, agent, kind, here + glm::dvec3(0.4, 0, 1.2));
    }
    const HerdState awake = compare(40);
    EXPECT_EQ(sleepersOf(awake), agents - woken);
    for (uint32_t agent = 0; agent < agents; ++agent)
      EXPECT_EQ(sameBits(recordsOf(asleep, agent), recordsOf(awake, agent)), agent % 3 != 0) << agent;
    expectAllPass(replay.results());
  }
}

TEST_P(SleepTest, WhoArrivesSleepsAndMayBeWoken) {
  const Heightfield ground = smallRollingGround();
  Crowd crowd(device(), ground, arriving(9, controller()), sleeping());
  const HerdState start = crowd.download(0);
  while (sleepersOf(crowd.download(0)) < 9 && crowd.tick() < 1200) simulate(device(), crowd, 20);
  const HerdState asleep = crowd.download(0);
  ASSERT_EQ(sleepersOf(asleep), 9u);
  for (size_t agent = 0; agent < 9; ++agent) {
    const glm::dvec3 p = positionOf(asleep, agent);
    EXPECT_LT(std::hypot(p.x, p.z - 2), crowd.rig(0).legLength) << "agent " << agent;
    if (std::hypot(positionOf(start, agent).x, positionOf(start, agent).z - 2) < 1) continue;
    EXPECT_GT(glm::length(p - positionOf(start, agent)), 0.3) << "agent " << agent;
  }
  const uint64_t hash = crowd.stateHash();
  simulate(device(), crowd, 50);
  EXPECT_EQ(crowd.stateHash(), hash);

  wish(context(), crowd, 4, shared::GOAL_POINT, {0, 0, 5});
  simulate(device(), crowd, 1);
  HerdState now = crowd.download(0);
  EXPECT_EQ(sleepersOf(now), 8u);
  EXPECT_FALSE(sleeps(now, 4));
  while (!sleeps(now, 4) && crowd.tick() < 2400) {
    simulate(device(), crowd, 20);
    now = crowd.download(0);
  }
  EXPECT_EQ(sleepersOf(now), 9u);
  const glm::dvec3 p = positionOf(now, 4);
  EXPECT_LT(std::hypot(p.x, p.z - 5), crowd.rig(0).legLength);
  for (size_t agent = 0; agent < 9; ++agent)
    EXPECT_EQ(sameBits(recordsOf(asleep, agent), recordsOf(now, agent)), agent != 4) << "agent " << agent;
}

TEST_P(SleepTest, WhoCrossesNeverSleeps) {
  Crowd on(device(), smallRollingGround(), sceneOf(20, 2, 1, controller()), sleeping()),
      off(device(), smallRollingGround(), sceneOf(20, 2, 1, controller()));
  for (int i = 0; i < 12; ++i) {
    simulate(device(), on, 30);
    simulate(device(), off, 30);
    EXPECT_EQ(on.stateHash(), off.stateHash()) << "tick " << on.tick();
    EXPECT_EQ(sleepersOf(on.download(0)), 0u);
  }
}

TEST_P(SleepTest, NobodySleepsUnasked) {
  Crowd crowd(device(), smallRollingGround(), standing(9, controller()));
  simulate(device(), crowd, 1);
  for (int left = restTicks(crowd) + 60; left > 0; left -= 10) {
    simulate(device(), crowd, 10);
    const HerdState state = crowd.download(0);
    EXPECT_FALSE(state.sleep);
    for (size_t agent = 0; agent < 9; ++agent) ASSERT_EQ(state.steer[4 * agent + 2], 0) << agent;
  }
}

// An agent that is awake is what it would be if nobody slept, though its neighbours in memory do.
TEST_P(SleepTest, TheAwakeDoNotNotice) {
  const Heightfield ground = smallRollingGround();
  Crowd on(device(), ground, standing(21, controller()), sleeping()),
      off(device(), ground, standing(21, controller()));
  for (Crowd* crowd : {&on, &off}) {
    for (const size_t agent : {2u, 7u, 8u, 20u})
      wish(context(), *crowd, agent, shared::GOAL_CROSS, {3, 0, 10});
    simulate(device(), *crowd, 1);
    simulate(device(), *crowd, restTicks(*crowd) + 60);
  }
  const HerdState with = on.download(0), without = off.download(0);
  EXPECT_EQ(sleepersOf(with), 17u);
  for (size_t agent = 0; agent < 21; ++agent)
    EXPECT_TRUE(sleeps(with, agent) || sameBits(recordsOf(with, agent), recordsOf(without, agent)))
        << "agent " << agent;
}

// Blocks of eight that begin anywhere in the herd: it shows neither in who sleeps nor in anything else.
TEST_P(SleepTest, PagesSmallerThanABlockDoNotShow) {
  const Heightfield ground = smallRollingGround();
  Crowd whole(device(), ground, arriving(23, controller()), sleeping()),
      paged(device(), ground, arriving(23, controller()), sleeping(5));
  size_t least = 23, most = 0;
  for (int i = 0; i < 60 && most < 23; ++i) {
    simulate(device(), whole, 15);
    simulate(device(), paged, 15);
    const HerdState a = whole.download(0), b = paged.download(0);
    ASSERT_EQ(a.steer, b.steer) << "tick " << whole.tick();
    ASSERT_EQ(whole.stateHash(), paged.stateHash()) << "tick " << whole.tick();
    for (size_t agent = 0; agent < 23; ++agent)
      ASSERT_TRUE(sameBits(recordsOf(a, agent), recordsOf(b, agent))) << "agent " << agent;
    least = std::min(least, sleepersOf(a)), most = std::max(most, sleepersOf(a));
  }
  EXPECT_EQ(least, 0u);
  EXPECT_EQ(most, 23u);
}

TEST_P(SleepTest, GroundThatMovesWakesThem) {
  const bool steps = controller() == Controller::adaptive;  // the others' feet follow their bodies
  Crowd crowd(device(), flatGround(), standing(9, controller()), sleeping());
  simulate(device(), crowd, 1);
  simulate(device(), crowd, restTicks(crowd));
  validation::Replay replay(validation::herdFacts(implOf(crowd).kindOf(0), crowd.terrain()));
  HerdState state = crowd.download(0);
  const HerdState asleep = state;
  ASSERT_EQ(sleepersOf(asleep), 9u);
  const auto tick = [&] {
    simulate(device(), crowd, 1);
    HerdState after = crowd.download(0);
    replay.tick(crowd.tick(), state, after);
    state = std::move(after);
  };
  tick();
  EXPECT_EQ(sleepersOf(state), 9u);

  raise(crowd, 0.1f);
  replay.edit(0, 0, crowd.terrain().columns, crowd.terrain().rows, crowd.terrain().heights);
  uint32_t lifted[9] = {};
  const uint64_t edited = crowd.tick();
  for (tick(); state.watched; tick()) {
    EXPECT_EQ(sleepersOf(state), 0u) << "tick " << crowd.tick();
    for (size_t agent = 0; agent < 9; ++agent)
      lifted[agent] |= static_cast<uint32_t>(state.gait[agent * shared::GAIT_STRIDE * 4 + 1]);
  }
  EXPECT_GE(crowd.tick() - edited, 120u);
  for (int left = restTicks(crowd); left > 0 && sleepersOf(state) < 9; --left) tick();
  EXPECT_EQ(sleepersOf(state), 9u);
  for (size_t agent = 0; agent < 9; ++agent) {
    EXPECT_EQ(lifted[agent], steps ? 0xffu : 0) << "agent " << agent;
    EXPECT_NEAR(positionOf(state, agent).y - positionOf(asleep, agent).y, 0.1, 0.01) << "agent " << agent;
  }
  for (size_t leg = 0; steps && leg < 9 * 8; ++leg)
    EXPECT_NEAR(state.step[leg * shared::STEP_STRIDE * 4 + 1], 0.1f, 1e-3f) << "leg " << leg;
  const uint64_t hash = crowd.stateHash();
  simulate(device(), crowd, 60);
  EXPECT_EQ(crowd.stateHash(), hash);
  expectAllPass(replay.results());
}

std::string caseName(const ::testing::TestParamInfo<Case>& info) {
  return testNameOf(std::get<1>(info.param)) +
         (std::get<0>(info.param) == LoadPath::texel ? "Texel" : "Storage");
}
INSTANTIATE_TEST_SUITE_P(, SleepTest,
                         ::testing::Combine(::testing::Values(LoadPath::texel),
                                            ::testing::ValuesIn(allControllers)),
                         caseName);
// One controller shows that the other load path is bound: SleepHerdsTest.RecordPathsAgreeToTheBit compares
// them.
INSTANTIATE_TEST_SUITE_P(Loads, SleepTest, ::testing::Values(Case(LoadPath::storage, Controller::adaptive)),
                         caseName);

using SleepHerdsTest = GpuTest;

TEST_F(SleepHerdsTest, OneSleepsAndTheOtherWalks) {
  const Heightfield ground = rollingGround();
  Scene scene = sceneOf(11), alone = sceneOf(11);
  scene.herds.push_back(standing(13).herds[0]);
  Crowd crowd(device(), ground, scene, sleeping()), walkers(device(), ground, alone);
  simulate(device(), crowd, 1);
  simulate(device(), walkers, 1);
  const int ticks = restTicks(crowd, 1) + 30;
  simulate(device(), crowd, ticks);
  simulate(device(), walkers, ticks);
  const HerdState walking = crowd.download(0), resting = crowd.download(1), before = walkers.download(0);
  EXPECT_EQ(sleepersOf(walking), 0u);
  EXPECT_EQ(sleepersOf(resting), 13u);
  for (size_t agent = 0; agent < 11; ++agent)
    EXPECT_TRUE(sameBits(recordsOf(walking, agent), recordsOf(before, agent))) << "agent " << agent;
  simulate(device(), crowd, 30);
  const HerdState later = crowd.download(1);
  for (size_t agent = 0; agent < 13; ++agent)
    EXPECT_TRUE(sameBits(recordsOf(resting, agent), recordsOf(later, agent))) << "agent " << agent;
}

// The crowd's count is the sleepers of all herds and pages, from nobody to all that stand.
TEST_F(SleepHerdsTest, TheyAreCounted) {
  Scene scene = sceneOf(5);
  scene.herds.push_back(standing(20).herds[0]);
  scene.herds.push_back(standing(9, Controller::loop).herds[0]);
  for (const uint32_t pageAgents : {0u, 7u}) {
    SCOPED_TRACE(pageAgents);
    Crowd crowd(device(), smallRollingGround(), scene, sleeping(pageAgents));
    EXPECT_EQ(crowd.sleeping(), 0u);
    simulate(device(), crowd, 1);
    std::set<uint64_t> counts;
    for (int left = std::max(restTicks(crowd, 1), restTicks(crowd, 2)); left > 0; left -= 10) {
      simulate(device(), crowd, 10);
      size_t sleepers = 0;
      for (uint32_t herd = 0; herd < crowd.herdCount(); ++herd) sleepers += sleepersOf(crowd.download(herd));
      ASSERT_EQ(crowd.sleeping(), sleepers) << "tick " << crowd.tick();
      counts.insert(sleepers);
    }
    EXPECT_EQ(*counts.begin(), 0u);
    EXPECT_EQ(*counts.rbegin(), 29u);
    EXPECT_GT(counts.size(), 3u);
  }
  Crowd awake(device(), smallRollingGround(), scene);
  simulate(device(), awake, 1);
  EXPECT_EQ(awake.sleeping(), 0u);
}

TEST_F(SleepHerdsTest, RecordPathsAgreeToTheBit) {
  if (!hasTexelPath()) GTEST_SKIP() << "the device has one load path only";
  const auto hashAfter = [&](const DeviceRequest& request) {
    Device device = Device::create(request);
    uint64_t hash = 0;
    {
      Crowd crowd(device, smallRollingGround(), arriving(65), sleeping());
      simulate(device, crowd, 300);
      EXPECT_GT(sleepersOf(crowd.download(0)), 0u);
      hash = crowd.stateHash();
    }
    failOnMessages(*device.validationLog());
    return hash;
  };
  std::set<uint64_t> hashes;
  for (const DeviceRequest& request : everyRecordPath()) hashes.insert(hashAfter(request));
  EXPECT_EQ(hashes.size(), 1u);
}

}  // namespace
}  // namespace skitter::test

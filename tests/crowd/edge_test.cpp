// Sizes that are no multiple of anything, and inputs that are nasty.
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "crowd/herd.h"
#include "crowd/page.h"
#include "crowd/simulation.h"
#include "crowd/spawn.h"
#include "gpu/transfer.h"
#include "skitter/error.h"
#include "validation/herd_facts.h"

namespace skitter::test {
namespace {

using EdgeTest = GpuLoadTest;

void expectFinite(const HerdState& state) {
  for (const auto* records :
       {&state.body, &state.gait, &state.step, &state.arc, &state.foot, &state.chain, &state.pose})
    for (const float value : *records) ASSERT_TRUE(std::isfinite(value));
}

TEST_P(EdgeTest, AnyNumberOfAgents) {
  const Heightfield ground = rollingGround();
  for (const uint32_t agents : {0u, 1u, 63u, 64u, 65u, 1234u}) {
    SCOPED_TRACE(agents);
    Crowd crowd(device(), ground, sceneOf(agents));
    const std::vector<validation::StageResult> stages = replay(device(), crowd, ground, 3);
    if (agents > 0) {
      expectAllPass(stages);
    } else {
      // Nothing was compared, which is no pass.
      for (const validation::StageResult& stage : stages) EXPECT_EQ(stage.why, "no samples") << stage.name;
    }
    const HerdState state = crowd.download(0);
    EXPECT_EQ(state.agents, agents);
    expectFinite(state);
  }
}

TEST_P(EdgeTest, CliffsAndTheTerrainsEdge) {
  const Heightfield ground = cliffGround();
  Crowd crowd(device(), ground, sceneOf(64, 2));
  simulate(device(), crowd, 300);
  expectAllPass(replay(device(), crowd, ground, 60));
  expectFinite(crowd.download(0));
}

// However fast they are told to be.
TEST_P(EdgeTest, NobodyLeavesTheMap) {
  const Heightfield ground = smallRollingGround();
  for (const Controller controller : allControllers) {
    SCOPED_TRACE(nameOf(controller));
    Crowd crowd(device(), ground, sceneOf(64, 1000, 1, controller));
    double farthest = 0;
    for (int i = 0; i < 40; ++i) {
      simulate(device(), crowd, 15);
      const HerdState state = crowd.download(0);
      for (size_t agent = 0; agent < state.agents; ++agent) {
        const glm::dvec3 place = positionOf(state, agent);
        farthest = std::max({farthest, std::abs(place.x), std::abs(place.z)});
      }
    }
    EXPECT_LE(farthest, 0.5 * ground.extentX() * (1 + 1e-6));
    EXPECT_GT(farthest, 0.45 * ground.extentX());  // they went there
  }
}

TEST_P(EdgeTest, TheSmallestTerrain) {
  Heightfield tiny;
  tiny.columns = tiny.rows = 2;
  tiny.heights = {0, 0.2f, 0.1f, 0.3f};
  Crowd crowd(device(), tiny, sceneOf(5));
  expectAllPass(replay(device(), crowd, tiny, 60));
  expectFinite(crowd.download(0));
}

TEST_P(EdgeTest, FeetThatCannotBeFollowedKeepThePose) {
  const Heightfield ground = flatGround();
  Crowd crowd(device(), ground, sceneOf(3));
  simulate(device(), crowd, 2);
  // A landing that is not a number, as a broken caller might write it.
  const crowd::Page& page = implOf(crowd).kindOf(0).pages[0];
  std::vector<float> steps = gpu::download<float>(context(), page.step);
  steps[0] = std::numeric_limits<float>::quiet_NaN();
  gpu::upload(context(), page.step, steps);
  const HerdState before = crowd.download(0);
  simulate(device(), crowd, 1);
  const HerdState after = crowd.download(0);
  EXPECT_GE(crowd.fidelity().notFinite, 1u);
  // Its legs keep their directions, and nobody else notices.
  const auto stride = static_cast<size_t>(shared::chainStride(crowd.rig(0).maxBones())) * 4;
  for (size_t leg = 0; leg < 8; ++leg)
    for (size_t i = 0; i < stride; ++i)
      EXPECT_NEAR(after.chain[leg * stride + i], before.chain[leg * stride + i], 1e-6) << leg;
  for (size_t i = after.pose.size() / 3; i < after.pose.size(); ++i)
    ASSERT_TRUE(std::isfinite(after.pose[i]));
}

INSTANTIATE_TEST_SUITE_P(, EdgeTest, bothLoadPaths(), loadPathName);

using WallsTest = GpuTest;

// Walls of a kilometre between two samples. A micrometre aside is two millimetres of height there, so ties
// are not rare; and which way ik goes where no foot can reach its target is not the point here.
TEST_F(WallsTest, GroundThatNobodyCanWalk) {
  std::mt19937 random(7);
  const std::pair<const char*, std::function<float(uint32_t, uint32_t)>> grounds[] = {
      {"stairs", [](uint32_t row, uint32_t) { return 1000 * static_cast<float>(row / 16) - 3500; }},
      {"checkerboard",
       [](uint32_t row, uint32_t column) { return (row / 8 + column / 8) % 2 == 0 ? -500.0f : 500.0f; }},
      {"spikes",
       [&](uint32_t, uint32_t) { return 1000 * static_cast<float>(random() >> 8) * 0x1p-24f - 500; }}};
  for (const auto& [name, height] : grounds) {
    Heightfield ground = generateHeightfield({.columns = 128, .rows = 128});
    for (uint32_t row = 0; row < ground.rows; ++row)
      for (uint32_t column = 0; column < ground.columns; ++column)
        ground.heights[row * ground.columns + column] = height(row, column);
    for (const Controller controller : {Controller::adaptive, Controller::planted}) {
      SCOPED_TRACE(std::string(name) + ", " + nameOf(controller));
      Crowd crowd(device(), ground, sceneOf(64, 1, 1, controller), CrowdOptions{.footfalls = UINT32_MAX});
      for (const validation::StageResult& stage : replay(device(), crowd, ground, 90))
        EXPECT_TRUE(stage.maxError <= stage.tolerance || stage.name == "ik")
            << stage.name << ": " << stage.worst;
      expectFinite(crowd.download(0));
    }
  }
}

using InputTest = GpuTest;

TEST_F(InputTest, RefusesWhatItDoesNotKnow) {
  Scene scene = sceneOf(1);
  scene.herds[0].solver = Solver::twoBone;
  EXPECT_THROW(Crowd(device(), flatGround(), scene), Error);
  scene.herds[0].controller = Controller::planted;
  scene.herds[0].solver = Solver::ccd;
  EXPECT_THROW(Crowd(device(), flatGround(), scene), Error);
  Crowd crowd(device(), flatGround(), sceneOf(1));
  EXPECT_THROW(simulate(device(), crowd, 1, 0), Error);
  EXPECT_THROW(simulate(device(), crowd, 1, std::numeric_limits<float>::quiet_NaN()), Error);
}

TEST_F(InputTest, RefusesStepsThatTheirRecordsDoNotHold) {
  Crowd crowd(device(), flatGround(), sceneOf(1));
  EXPECT_THROW(simulate(device(), crowd, 1, 2e-5f), Error);  // 17,500 ticks a step
  simulate(device(), crowd, 1, 2.5e-5f);
  Crowd looping(device(), flatGround(), sceneOf(1, 1, 1, Controller::loop));
  simulate(device(), looping, 1, 2e-5f);
  Rig giant = crowd.rig(0);
  giant.legLength = 101;
  EXPECT_THROW(Crowd(device(), flatGround(), sceneOf(1), {.rigs = {giant}}), Error);
  EXPECT_NO_THROW(Crowd(device(), flatGround(), sceneOf(1, 1, 1, Controller::loop), {.rigs = {giant}}));
}

TEST_F(InputTest, TakesOneRigAHerdOrNone) {
  EXPECT_NO_THROW(Crowd(device(), flatGround(), sceneOf(1), {}));
  try {
    Crowd(device(), flatGround(), sceneOf(1), {.rigs = {spiderRig(), spiderRig()}});
    FAIL() << "two rigs for one herd were taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("2 rigs were given, expected one for each of 1 herds"));
  }
}

TEST_F(InputTest, RefusesMoreAgentsThanThereIsMemoryFor) {
  Scene scene = sceneOf(2'000'000'000);
  try {
    Crowd crowd(device(), flatGround(), scene);
    FAIL() << "was made";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::device);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("2000000000 agents need"));
  }
}

uint64_t bytesOf(const Crowd& crowd, const char* name) {
  for (const MemoryUse& use : crowd.memoryUse(0))
    if (use.name == name) return use.bytes;
  return 0;
}

TEST_F(InputTest, MemoryIsWhatWasForetold) {
  for (const Controller controller : {Controller::adaptive, Controller::clip, Controller::planted})
    for (const CrowdOptions& options : {CrowdOptions{}, CrowdOptions{.pose = false, .measure = false},
                                        CrowdOptions{.watchEvery = 3, .footfalls = 11, .pageAgents = 7}}) {
      SCOPED_TRACE(nameOf(controller));
      const Crowd crowd(device(), flatGround(), sceneOf(23, 1, 1, controller), options);
      EXPECT_EQ(crowd.memoryBytes(), crowd::bytesOf(implOf(crowd), implOf(crowd).kindOf(0)));
      const uint64_t pages = options.pageAgents > 0 ? 4 : 1;
      EXPECT_EQ(bytesOf(crowd, "body"), 23 * 64u);
      EXPECT_EQ(bytesOf(crowd, "pose") > 0, options.pose);
      EXPECT_EQ(bytesOf(crowd, "metric"), options.measure ? 23 * 112u : 0);
      // Without, what a binding needs.
      EXPECT_EQ(bytesOf(crowd, "tip") > 8 * 8 * 16, options.measure);
      EXPECT_EQ(bytesOf(crowd, "footfall"), options.footfalls > 0 ? pages * 11 * 32 : 0);
    }
}

// Agents cross to the far side on their own lane and come back half a lane beside it. Nobody's goal is nearer
// to an edge than one and a half of its margin.
TEST_F(InputTest, AgentsComeBackBesideTheirLane) {
  const Heightfield ground = flatGround();
  Scene scene = sceneOf(9);
  scene.herds[0].spawn.centre = {26, 0};
  Crowd crowd(device(), ground, scene);
  const HerdState state = crowd.download(0);
  const shared::Parameters& tuning = implOf(crowd).kindOf(0).parameters;
  const double limitX = tuning.halfExtentX - 1.5 * tuning.edgeMargin,
               limitZ = tuning.halfExtentZ - 1.5 * tuning.edgeMargin;
  size_t held = 0;
  for (size_t agent = 0; agent < 9; ++agent) {
    const float* goal = &state.goal[agent * shared::GOAL_STRIDE * 4];
    const double x = positionOf(state, agent).x, beside = x + 0.5 * scene.herds[0].spawn.spacing;
    EXPECT_NEAR(goal[0], x, 1e-5) << "agent " << agent;
    EXPECT_NEAR(goal[1], limitZ, 1e-5) << "agent " << agent;
    EXPECT_NEAR(goal[2], std::min(beside, limitX), 1e-5) << "agent " << agent;
    EXPECT_NEAR(goal[3], -limitZ, 1e-5) << "agent " << agent;
    held += beside > limitX ? 1 : 0;
  }
  EXPECT_GT(held, 0u);
  EXPECT_LT(held, 9u);

  scene.herds[0].goal = {.kind = Goal::Kind::point, .target = {3, -4}};
  const std::vector<float> goals = Crowd(device(), ground, scene).download(0).goal;
  EXPECT_THAT(std::vector(goals.begin(), goals.begin() + 4), ::testing::ElementsAre(3, -4, 3, -4));
}

// As many as are spread over threads, and in runs that one thread writes.
TEST_F(InputTest, SpawningIsTheSameOnAnyNumberOfThreads) {
  constexpr uint32_t agents = 9024, run = 1504;  // whole blocks
  const Scene scene = sceneOf(agents);
  const Heightfield ground = rollingGround();
  const Crowd crowd(device(), ground, sceneOf(1));
  const crowd::Spawner spawner(scene.herds[0], implOf(crowd).kindOf(0), ground, scene.seed);
  const auto records = [](std::vector<float>& floats) {
    const auto part = [&](size_t at, size_t each) {
      return std::span(floats).subspan(agents * at, agents * each);
    };
    crowd::SpawnRecords to;
    to.goal = part(0, 8), to.body = part(8, 16), to.gait = part(24, 8), to.step = part(32, 64);
    to.foot = part(96, 32), to.chain = part(128, 64), to.tip = part(192, 32);
    return to;
  };
  std::vector<float> whole(agents * 224), runs(agents * 224);
  spawner.write(0, agents, 0, records(whole));
  for (uint32_t first = 0; first < agents; first += run) spawner.write(first, run, first, records(runs));
  EXPECT_EQ(whole, runs);
}

// The records that a download of the sample must hold, taken from `whole` agent by agent.
std::vector<float> sampled(const std::vector<float>& whole, const HerdState& state,
                           const AgentSample& sample) {
  const size_t each = whole.size() / state.agents;
  std::vector<float> records;
  for (size_t agent = sample.first; agent < state.agents; agent += sample.stride)
    records.insert(records.end(), whole.begin() + static_cast<std::ptrdiff_t>(agent * each),
                   whole.begin() + static_cast<std::ptrdiff_t>((agent + 1) * each));
  return records;
}

TEST_F(InputTest, ASampleIsWhatTheWholeHas) {
  Crowd crowd(device(), rollingGround(), sceneOf(23), CrowdOptions{.watchEvery = 3, .pageAgents = 7});
  simulate(device(), crowd, 30);
  const HerdState whole = crowd.download(0);
  for (const AgentSample& sample : {AgentSample{0, 1}, AgentSample{0, 5}, AgentSample{4, 5},
                                    AgentSample{8, 9}, AgentSample{22, 100}, AgentSample{23, 24}}) {
    SCOPED_TRACE(std::to_string(sample.first) + " and every " + std::to_string(sample.stride));
    const HerdState part = crowd.download(0, sample);
    EXPECT_EQ(part.agents, sample.first < 23 ? (23 - sample.first + sample.stride - 1) / sample.stride : 0);
    for (const auto records :
         {&HerdState::goal, &HerdState::steer, &HerdState::body, &HerdState::gait, &HerdState::step,
          &HerdState::arc, &HerdState::foot, &HerdState::chain, &HerdState::pose, &HerdState::metric})
      EXPECT_EQ(part.*records, sampled(whole.*records, whole, sample));
    EXPECT_EQ(part.watch, whole.watch);
  }
}

TEST_F(InputTest, ASampleIsValidated) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device(), ground, sceneOf(23), CrowdOptions{.watchEvery = 3, .pageAgents = 7});
  simulate(device(), crowd, 30);
  validation::Replay replay(validation::herdFacts(implOf(crowd).kindOf(0), ground));
  for (uint32_t first = 0; first < 5; ++first) {
    const HerdState before = crowd.download(0, {first, 5});
    simulate(device(), crowd, 1);
    replay.tick(crowd.tick(), before, crowd.download(0, {first, 5}));
  }
  expectAllPass(replay.results());
  EXPECT_EQ(replay.results()[0].samples, 23u);
}

TEST_F(InputTest, WhatIsLeftOutIsNotRead) {
  Crowd crowd(device(), flatGround(), sceneOf(5), CrowdOptions{.pose = false, .measure = false});
  simulate(device(), crowd, 2);
  const HerdState state = crowd.download(0);
  EXPECT_TRUE(state.pose.empty());
  EXPECT_TRUE(state.metric.empty());
  EXPECT_TRUE(state.tip.empty());
  EXPECT_TRUE(state.foot.empty());
  EXPECT_EQ(crowd.fidelity().agentTicks, 0u);
  EXPECT_TRUE(crowd.footfalls(0).empty());
  EXPECT_EQ(state.body.size(), 5 * 16u);
}

}  // namespace
}  // namespace skitter::test

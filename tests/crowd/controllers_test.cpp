// What holds of every controller, and what loop, clip, planted and pose promise.
#include <cmath>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "cpu_reference/stages/clip.h"
#include "crowd/herd.h"
#include "crowd/simulation.h"
#include "validation/convert.h"
#include "validation/convert_clip.h"

namespace skitter::test {
namespace {

// All but adaptive, of which most tests are.
std::vector<Controller> allButAdaptive() {
  std::vector<Controller> controllers(allControllers.begin(), allControllers.end());
  std::erase(controllers, Controller::adaptive);
  return controllers;
}

void expectPass(const std::vector<validation::StageResult>& results) {
  for (const validation::StageResult& stage : results) {
    EXPECT_TRUE(stage.pass) << stage.name << ": " << stage.why;
    EXPECT_GT(stage.samples, 0u) << stage.name;
  }
}

using Case = std::tuple<LoadPath, Controller>;

class ControllersTest : public GpuTest, public ::testing::WithParamInterface<Case> {
 protected:
  ControllersTest() : GpuTest(std::get<0>(GetParam())) {}
  Controller controller() const { return std::get<1>(GetParam()); }
};

TEST_P(ControllersTest, FromAStandingStart) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device(), ground, sceneOf(40, 1, 1, controller()), CrowdOptions{.footfalls = UINT32_MAX});
  expectPass(replay(device(), crowd, ground, 180));
}

TEST_P(ControllersTest, TurnsRoundAndStops) {
  Scene scene = sceneOf(16, 1.5f, 3, controller());
  scene.herds[0].spawn.kind = Spawn::Kind::grid;
  scene.herds[0].spawn.heading = 3;  // nearly away from the target
  scene.herds[0].goal = {.kind = Goal::Kind::point, .target = {0, 2}, .speed = 1.5f};
  const Heightfield ground = smallRollingGround();
  Crowd crowd(device(), ground, scene, CrowdOptions{.footfalls = UINT32_MAX});
  expectPass(replay(device(), crowd, ground, 420));
}

TEST_P(ControllersTest, TurnsBackAtTheEdgeAndFast) {
  const Heightfield ground = smallRollingGround();
  Crowd crowd(device(), ground, sceneOf(16, 3, 7, controller()), CrowdOptions{.footfalls = UINT32_MAX});
  simulate(device(), crowd, 420);
  expectPass(replay(device(), crowd, ground, 180));
}

// Feet are wanted beyond the edge of a plateau, where the body stops (docs/stages/body.md, walls and cliffs).
TEST_P(ControllersTest, UpToACliff) {
  const Heightfield ground = cliffGround();
  Crowd crowd(device(), ground, sceneOf(16, 2, 1, controller()), CrowdOptions{.footfalls = UINT32_MAX});
  const auto stopped = [&] {
    const HerdState state = crowd.download(0);
    size_t count = 0;
    for (size_t agent = 0; agent < state.agents; ++agent) {
      EXPECT_GT(positionOf(state, agent).y, -7) << "agent " << agent;
      count += state.body[16 * agent + 14] < 0.05f ? 1 : 0;
    }
    return count;
  };
  while (stopped() == 0 && crowd.tick() < 2000) simulate(device(), crowd, 20);
  ASSERT_GT(stopped(), 0u);
  expectPass(replay(device(), crowd, ground, 90));
  EXPECT_GT(stopped(), 0u);
}

TEST_P(ControllersTest, AnyNumberOfAgentsInAnyPages) {
  const Heightfield ground = smallRollingGround();
  const auto hashOf = [&](uint32_t agents, const CrowdOptions& options) {
    Crowd crowd(device(), ground, sceneOf(agents, 1, 1, controller()), options);
    simulate(device(), crowd, 40);
    const HerdState state = crowd.download(0);
    EXPECT_EQ(state.agents, agents);
    for (const Record record : allRecords)
      for (const float value : state.of(record)) {
        EXPECT_TRUE(std::isfinite(value));
        if (!std::isfinite(value)) return uint64_t{0};
      }
    return crowd.stateHash();
  };
  for (const uint32_t agents : {0u, 1u, 63u, 64u, 65u}) {
    SCOPED_TRACE(agents);
    const uint64_t whole = hashOf(agents, {});
    EXPECT_EQ(whole, hashOf(agents, {})) << "twice the same";
    EXPECT_EQ(whole, hashOf(agents, {.pageAgents = 7})) << "pages show";
  }
}

std::string controllerName(const ::testing::TestParamInfo<Case>& param) {
  return testNameOf(std::get<1>(param.param));
}

INSTANTIATE_TEST_SUITE_P(, ControllersTest,
                         ::testing::Combine(::testing::Values(LoadPath::texel),
                                            ::testing::ValuesIn(allButAdaptive())),
                         controllerName);
// One controller shows that the other load path is bound: ControllerTest.RecordPathsAgreeToTheBit compares
// them.
INSTANTIATE_TEST_SUITE_P(Storage, ControllersTest,
                         ::testing::Values(Case(LoadPath::storage, Controller::planted)), controllerName);

using BrokenLimitsTest = GpuLoadTest;

// Cones that the clips were not made for: some bones are beyond them by 0.45 rad.
Rig narrowSpider() {
  Rig rig = spiderRig();
  for (Leg& leg : rig.legs)
    for (Bone& bone : leg.bones) bone.coneHalfAngle = 0.01f;
  return rig;
}

TEST_P(BrokenLimitsTest, AreMeasuredAsAnglesAndNotJudged) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device(), ground, sceneOf(16, 1, 1, Controller::clip),
              {.footfalls = UINT32_MAX, .rigs = {narrowSpider()}});
  expectPass(replay(device(), crowd, ground, 60));
  EXPECT_GT(validation::metricOf(crowd.download(0), 0).largestViolation, 0.4);
  EXPECT_FALSE(crowd.fidelity().limitViolation.has_value());
  EXPECT_FALSE(crowd.agentFidelity(0).at(0).limitViolations.has_value());
}

// A clip's violations are no part of what is told of the herds that keep the limits.
TEST_P(BrokenLimitsTest, AreNotCountedAmongKeptOnes) {
  Scene scene = sceneOf(16, 1, 1, Controller::clip);
  scene.herds.push_back(sceneOf(16).herds[0]);
  Crowd crowd(device(), rollingGround(), scene, {.rigs = {narrowSpider(), spiderRig()}});
  simulate(device(), crowd, 60);
  ASSERT_TRUE(crowd.fidelity().limitViolation.has_value());
  EXPECT_EQ(crowd.fidelity().limitViolation, crowd.fidelity(1).limitViolation);
  EXPECT_EQ(crowd.fidelity().limitViolations, crowd.fidelity(1).limitViolations);
  EXPECT_LT(*crowd.fidelity().limitViolation, 1e-4);
}

// A herd that is gone keeps none.
TEST_P(BrokenLimitsTest, AreNotTheMatterOfWhoIsGone) {
  Scene scene = sceneOf(4, 1, 1, Controller::clip);
  scene.herds.push_back(sceneOf(3, 1, 1, Controller::planted).herds[0]);
  Crowd crowd(device(), rollingGround(), scene);
  crowd.removeHerd(crowd.herdId(1));
  simulate(device(), crowd, 2);
  EXPECT_FALSE(crowd.fidelity().limitViolation.has_value());
  EXPECT_FALSE(crowd.fidelity(1).limitViolation.has_value());
}

INSTANTIATE_TEST_SUITE_P(, BrokenLimitsTest, bothLoadPaths(), loadPathName);

class ControllerTest : public GpuTest, public ::testing::WithParamInterface<Controller> {};

TEST_P(ControllerTest, RecordPathsAgreeToTheBit) {
  if (!hasTexelPath()) GTEST_SKIP() << "the device has one load path only";
  const auto hashAfter = [&](const DeviceRequest& request) {
    Device device = Device::create(request);
    uint64_t hash = 0;
    {
      Crowd crowd(device, rollingGround(), sceneOf(65, 1, 1, GetParam()));
      simulate(device, crowd, 60);
      hash = crowd.stateHash();
    }
    failOnMessages(*device.validationLog());
    return hash;
  };
  std::set<uint64_t> hashes;
  for (const DeviceRequest& request : everyRecordPath()) hashes.insert(hashAfter(request));
  EXPECT_EQ(hashes.size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(, ControllerTest, ::testing::ValuesIn(allButAdaptive()),
                         [](const auto& param) { return testNameOf(param.param); });

using ClipHerdTest = GpuTest;

// The first picture, and the feet that are put on the ground before the first tick, are of what is played.
TEST_F(ClipHerdTest, BeginsWithTheFramesOfItsTime) {
  for (const Controller controller : {Controller::clip, Controller::planted}) {
    Crowd crowd(device(), rollingGround(), sceneOf(20, 1, 1, controller));
    const crowd::Kind& kind = implOf(crowd).kindOf(0);
    const reference::ClipTable table = validation::clipTableOf(kind.clips, kind.legs, kind.bones);
    const HerdState state = crowd.download(0);
    for (size_t agent = 0; agent < 20; ++agent) {
      const reference::Play play = validation::playOf(state, agent, table);
      for (reference::Play::Played played : {play.to, play.from}) {
        EXPECT_EQ(played.clip, kind.clips.standing);
        const size_t frame = played.frame;
        const double fraction = played.fraction;
        reference::findFrame(table, played);
        EXPECT_EQ(frame, played.frame);
        EXPECT_NEAR(fraction, played.fraction, 1e-5);
      }
    }
  }
}

// An agent that stands begins in the clip for it, wherever that is among the herd's clips, and stays there.
TEST_F(ClipHerdTest, BeginsInTheStandingClip) {
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{}, {"walk", "idle"}, {"idle", "walk"}, {"walk"}}) {
    SCOPED_TRACE(testing::PrintToString(names));
    Scene scene = sceneOf(9, 1, 1, Controller::clip);
    scene.herds[0].goal.kind = Goal::Kind::none;
    scene.herds[0].clips = names;
    Crowd crowd(device(), smallRollingGround(), scene);
    const std::vector<const Clip*> clips = crowd::chosenClips(implOf(crowd).kindOf(0).clipSet, names);
    for (int tick = 0; tick < 3; ++tick) {
      const HerdState state = crowd.download(0);
      for (size_t agent = 0; agent < 9; ++agent) {
        const float* play = &state.play[agent * shared::PLAY_STRIDE * 4];
        const float to = play[0], from = play[2], weight = play[4];
        EXPECT_EQ(clips.at(static_cast<size_t>(to))->name, names.size() == 1 ? "walk" : "idle");
        EXPECT_EQ(from, to);
        EXPECT_EQ(weight, 1);
      }
      simulate(device(), crowd, 1);
    }
  }
}

using HerdsTest = GpuTest;

// Herds with different stages in one crowd: each does what it does alone, and passes.
TEST_F(HerdsTest, ControllersMix) {
  const Heightfield ground = smallRollingGround();
  Scene scene = sceneOf(12);
  for (const Controller controller : allButAdaptive()) {
    Herd& herd = scene.herds.emplace_back(scene.herds[0]);
    herd.controller = controller;
    herd.agents += 5;
  }
  Crowd crowd(device(), ground, scene, CrowdOptions{.footfalls = UINT32_MAX});
  const auto results = replayAll(device(), crowd, ground, 90);
  ASSERT_EQ(results.size(), scene.herds.size());
  expectAllPass(results[0]);
  for (size_t h = 1; h < results.size(); ++h) {
    SCOPED_TRACE(nameOf(scene.herds[h].controller));
    expectPass(results[h]);
  }
  Crowd alone(device(), ground, sceneOf(12));
  simulate(device(), alone, 91);
  EXPECT_EQ(alone.download(0).body, crowd.download(0).body);
  EXPECT_EQ(alone.download(0).step, crowd.download(0).step);
}

// How far feet slide while they stand, in leg lengths a stance. A stance that had begun before, or has not
// ended, does not count.
struct Slip {
  double mean = 0, worst = 0;
  size_t stances = 0;
};

Slip slipOver(Device& device, Crowd& crowd, int ticks) {
  const Rig& rig = crowd.rig(0);
  const auto legs = static_cast<size_t>(rig.legCount());
  const auto feetOf = [&](const HerdState& state) {
    std::vector<glm::dvec3> feet;
    for (size_t leg = 0; leg < state.agents * legs; ++leg) {
      const float* tip = &state.tip[leg * 4];
      feet.push_back(positionOf(state, leg / legs) + glm::dvec3(tip[0], tip[1], tip[2]));
    }
    return feet;
  };
  HerdState before = crowd.download(0);
  std::vector<glm::dvec3> last = feetOf(before);
  std::vector<double> slid(last.size(), -1);  // -1: its beginning was not seen
  Slip slip;
  for (int i = 0; i < ticks; ++i) {
    simulate(device, crowd, 1);
    const HerdState after = crowd.download(0);
    const std::vector<glm::dvec3> feet = feetOf(after);
    for (size_t leg = 0; leg < feet.size(); ++leg) {
      const bool was = plantedOf(before, leg), is = plantedOf(after, leg);
      if (is && !was) slid[leg] = 0;
      if (is && was && slid[leg] >= 0)
        slid[leg] += std::hypot(feet[leg].x - last[leg].x, feet[leg].z - last[leg].z);
      if (is || !was || slid[leg] < 0) continue;
      const double share = slid[leg] / rig.legLength;
      slip.mean += share;
      slip.worst = std::max(slip.worst, share);
      ++slip.stances;
    }
    before = after;
    last = feet;
  }
  slip.mean /= static_cast<double>(std::max(slip.stances, size_t{1}));
  ::testing::Test::RecordProperty("meanSlip", std::to_string(slip.mean));
  ::testing::Test::RecordProperty("worstSlip", std::to_string(slip.worst));
  ::testing::Test::RecordProperty("stances", static_cast<int>(slip.stances));
  return slip;
}

// A lock is a constant: a foot that stands for an hour has not crept.
TEST_F(ClipHerdTest, LocksStayToTheBit) {
  Crowd crowd(device(), rollingGround(), sceneOf(16, 1, 1, Controller::planted));
  simulate(device(), crowd, 30);
  HerdState before = crowd.download(0);
  size_t kept = 0;
  for (int tick = 0; tick < 60; ++tick) {
    simulate(device(), crowd, 1);
    HerdState after = crowd.download(0);
    for (size_t leg = 0; leg < after.foot.size() / 4; ++leg) {
      const reference::Plant was = validation::plantOf(before, leg), is = validation::plantOf(after, leg);
      if (!was.locked || !is.locked) continue;
      ++kept;
      EXPECT_EQ(was.lock, is.lock);
      EXPECT_EQ(was.tileX, is.tileX);
      EXPECT_EQ(was.tileZ, is.tileZ);
    }
    before = std::move(after);
  }
  EXPECT_GT(kept, 1000u);
}

using SlipTest = GpuTest;

TEST_F(SlipTest, LoopsStandOnFlatGround) {
  Crowd crowd(device(), flatGround(), sceneOf(16, 1, 1, Controller::loop));
  simulate(device(), crowd, 120);  // straight on at a constant speed from then
  const Slip slip = slipOver(device(), crowd, 180);
  EXPECT_GT(slip.stances, 400u);
  EXPECT_LT(slip.mean, 5e-5);
}

TEST_F(SlipTest, PlantedFeetStandOnRollingGround) {
  Crowd crowd(device(), rollingGround(), sceneOf(16, 1, 1, Controller::planted));
  simulate(device(), crowd, 60);
  const Slip slip = slipOver(device(), crowd, 240);
  EXPECT_GT(slip.stances, 300u);
  EXPECT_LT(slip.mean, 5e-4);
}

TEST_F(SlipTest, ClipsRunAsFastAsTheGround) {
  Crowd crowd(device(), flatGround(), sceneOf(16, 1, 1, Controller::clip));
  simulate(device(), crowd, 120);
  const Slip slip = slipOver(device(), crowd, 180);
  EXPECT_GT(slip.stances, 300u);
  EXPECT_GT(slip.mean, 0.02);
  EXPECT_LT(slip.mean, 0.05);
}

TEST_F(SlipTest, KeyPosesGoAsFastAsTheGround) {
  Crowd crowd(device(), flatGround(), sceneOf(16, 1, 1, Controller::keyPoses));
  simulate(device(), crowd, 120);
  const Slip slip = slipOver(device(), crowd, 180);
  EXPECT_GT(slip.stances, 300u);
  EXPECT_GT(slip.mean, 0.04);
  EXPECT_LT(slip.mean, 0.1);
}

}  // namespace
}  // namespace skitter::test

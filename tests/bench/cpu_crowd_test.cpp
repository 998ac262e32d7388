// The CPU opponent before the judge that the devices stand before: lock-step replay against the reference.
#include "bench/cpu_crowd/crowd.h"

#include <algorithm>
#include <limits>

#include "crowd/herd.h"
#include "crowd/simulation.h"
#include "skitter/error.h"
#include "skitter/rig.h"
#include "validation/herd_facts.h"

namespace skitter::test {
namespace {

using cpu_crowd::CpuCrowd;
using cpu_crowd::Options;
using cpu_crowd::Width;

// A herd that a device has walked for some ticks.
struct Start {
  Start(Device& device, const Heightfield& ground, uint32_t agents, int ticks, float speed = 1)
      : Start(device, ground, sceneOf(agents, speed), ticks) {}
  Start(Device& device, const Heightfield& ground, const Scene& scene, int ticks)
      : terrain(ground), crowd(device, terrain, scene) {
    simulate(device, crowd, ticks);
    state = crowd.download(0);
  }
  Start(Device& device, const Heightfield& ground, uint32_t agents, int ticks, Rig rig)
      : terrain(ground), crowd(device, terrain, sceneOf(agents), {.rigs = {std::move(rig)}}) {
    simulate(device, crowd, ticks);
    state = crowd.download(0);
  }
  validation::HerdFacts facts() { return validation::herdFacts(implOf(crowd).kindOf(0), terrain); }

  Heightfield terrain;
  Crowd crowd;
  HerdState state;
};

// `ticks` ticks of `opponent`, which began at `start`, as the reference that knows `facts` sees them.
std::vector<validation::StageResult> replay(CpuCrowd& opponent, Start& start, int ticks,
                                            uint32_t stride = 1) {
  validation::Replay replay(start.facts());
  HerdState before = start.state;
  before.metric.clear();
  for (uint64_t n = start.crowd.tick() + 1; ticks-- > 0; ++n) {
    opponent.tick(n);
    HerdState after = opponent.state();
    const AgentSample sample{0, stride};
    replay.tick(n, validation::sampled(before, sample), validation::sampled(after, sample));
    before = std::move(after);
  }
  return replay.results();
}

void expectSamples(const std::vector<validation::StageResult>& results) {
  for (const validation::StageResult& stage : results) {
    if (stage.name == "measure" || stage.name == "footfall") continue;
    EXPECT_GT(stage.samples, 0u) << stage.name;
  }
}

Heightfield steepGround() {
  return generateHeightfield({.columns = 257, .rows = 257, .amplitude = 12, .wavelength = 24});
}

class CpuCrowdTest : public GpuTest, public ::testing::WithParamInterface<Width> {
 protected:
  Options options(int threads = 1) const { return {.threads = threads, .width = GetParam(), .poses = true}; }

  // The stages that replay refuses for an opponent that is told something else than the reference.
  std::string refusedStages(const validation::HerdFacts& broken, Start& start, int ticks) const {
    CpuCrowd opponent(broken, start.state, options());
    std::string names;
    for (const validation::StageResult& stage : replay(opponent, start, ticks))
      if (!stage.pass) names += stage.name + " ";
    return names;
  }
};

TEST_P(CpuCrowdTest, WalksAsTheReferenceDoes) {
  for (const uint32_t agents : {1u, 15u, 16u, 17u}) {
    Start start(device(), rollingGround(), agents, 90);
    CpuCrowd opponent(start.facts(), start.state, options());
    const auto results = replay(opponent, start, 60);
    SCOPED_TRACE(agents);
    expectAllPass(results);
    expectSamples(results);
  }
}

// Agents that turn round, and stop at their target.
Scene turningScene(Controller controller) {
  Scene scene = sceneOf(16, 1.5f, 3, controller);
  scene.herds[0].spawn.kind = Spawn::Kind::grid;
  scene.herds[0].spawn.heading = 3;  // nearly away from the target
  scene.herds[0].goal = {.kind = Goal::Kind::point, .target = {0, 2}, .speed = 1.5f};
  return scene;
}

TEST_P(CpuCrowdTest, TurnsRoundAndStops) {
  Start start(device(), smallRollingGround(), turningScene(Controller::adaptive), 1);
  CpuCrowd opponent(start.facts(), start.state, options());
  expectAllPass(replay(opponent, start, 420));
}

TEST_P(CpuCrowdTest, StepsWithoutARhythm) {
  Scene scene = sceneOf(16);
  scene.herds[0].stepping = Stepping::reach;
  Start start(device(), rollingGround(), scene, 60);
  CpuCrowd opponent(start.facts(), start.state, options());
  const auto results = replay(opponent, start, 60);
  expectAllPass(results);
  expectSamples(results);
}

TEST_P(CpuCrowdTest, WalksAThousandAsTheReferenceDoes) {
  Start start(device(), rollingGround(), 1000, 120);
  CpuCrowd opponent(start.facts(), start.state, options(3));
  const auto results = replay(opponent, start, 40, 20);
  expectAllPass(results);
  expectSamples(results);
}

TEST_P(CpuCrowdTest, WalksFastOnSteepGround) {
  Start start(device(), steepGround(), 40, 60, 2);
  CpuCrowd opponent(start.facts(), start.state, options());
  const auto results = replay(opponent, start, 60);
  expectAllPass(results);
  expectSamples(results);
}

TEST_P(CpuCrowdTest, BrakesBeforeTheEdge) {
  Start start(device(), smallRollingGround(), 16, 180, 1000);
  CpuCrowd opponent(start.facts(), start.state, options());
  expectAllPass(replay(opponent, start, 90));
}

// Beyond the wall no foothold fits, and legs hang in deadlocks that few other places have.
TEST_P(CpuCrowdTest, WalksOverACliff) {
  Start start(device(), cliffGround(), 64, 400);
  CpuCrowd opponent(start.facts(), start.state, options());
  expectAllPass(replay(opponent, start, 40));
}

TEST_P(CpuCrowdTest, WalksFromTheFirstStep) {
  Start start(device(), rollingGround(), 16, 1);
  CpuCrowd opponent(start.facts(), start.state, options());
  expectAllPass(replay(opponent, start, 40));
}

// Legs that are far from where their feet should be take all of ik's steps.
TEST_P(CpuCrowdTest, SolvesLegsThatAreFarOff) {
  Start start(device(), rollingGround(), 17, 30);
  std::vector<float>& chain = start.state.chain;
  for (size_t leg = 0; leg < chain.size() / 8; leg += 3)
    std::fill_n(chain.begin() + ptrdiff_t(8 * leg), 8, 0.0f);
  CpuCrowd opponent(start.facts(), start.state, options());
  expectAllPass(replay(opponent, start, 5));
}

// At rest in one line from root to home, which is nearer than they reach.
TEST_P(CpuCrowdTest, BendsStraightLegs) {
  Rig rig = spiderRig();
  for (Leg& leg : rig.legs)
    for (Bone& bone : leg.bones) bone.direction = glm::normalize(leg.home - leg.root());
  Start start(device(), rollingGround(), 17, 30, rig);
  std::vector<float>& chain = start.state.chain;
  for (size_t leg = 0; leg < chain.size() / 8; leg += 3)
    std::fill_n(chain.begin() + ptrdiff_t(8 * leg), 8, 0.0f);
  CpuCrowd opponent(start.facts(), start.state, options());
  expectAllPass(replay(opponent, start, 5));
}

TEST_P(CpuCrowdTest, WalksOnFourLegs) {
  Start start(device(), rollingGround(), 16, 60, loadRig(SKITTER_ASSETS "/quadruped.rig.json"));
  CpuCrowd opponent(start.facts(), start.state, options());
  const auto results = replay(opponent, start, 60);
  expectAllPass(results);
  expectSamples(results);
}

TEST_P(CpuCrowdTest, WalksOnStiffLegs) {
  Rig rig = spiderRig();
  rig.legs[2].bones[1].coneHalfAngle = 0;
  rig.legs[5].bones[2].coneHalfAngle = 0.1f;
  Start start(device(), rollingGround(), 16, 60, rig);
  CpuCrowd opponent(start.facts(), start.state, options());
  expectAllPass(replay(opponent, start, 60));
}

TEST_P(CpuCrowdTest, WalksOnLegsOfUnequalLength) {
  Rig rig = spiderRig();
  Leg& leg = rig.legs[1];
  leg.bones.pop_back();
  leg.reach = 0;
  for (const Bone& bone : leg.bones) leg.reach += bone.length;
  Start start(device(), rollingGround(), 16, 60, rig);
  CpuCrowd opponent(start.facts(), start.state, options());
  const auto results = replay(opponent, start, 60);
  expectAllPass(results);
  expectSamples(results);
}

// Feet are measure's alone: without it nobody swings.
void expectAllButSwingPass(std::vector<validation::StageResult> results) {
  std::erase_if(results, [](const auto& stage) { return stage.name == "swing"; });
  expectAllPass(results);
  expectSamples(results);
}

TEST_P(CpuCrowdTest, PlaysClipsAsTheReferenceDoes) {
  for (const uint32_t agents : {1u, 15u, 16u, 17u}) {
    Start start(device(), rollingGround(), sceneOf(agents, 1, 1, Controller::clip), 1);
    CpuCrowd opponent(start.facts(), start.state, options(2));
    SCOPED_TRACE(agents);
    expectAllButSwingPass(replay(opponent, start, 120));
  }
}

TEST_P(CpuCrowdTest, ChangesClipsAsItStops) {
  Start start(device(), smallRollingGround(), turningScene(Controller::clip), 1);
  CpuCrowd opponent(start.facts(), start.state, options());
  expectAllButSwingPass(replay(opponent, start, 420));
  CpuCrowd underWay(start.facts(), start.state, options());
  for (uint64_t n = 2; n < 120; ++n) underWay.tick(n);
  EXPECT_NE(underWay.state().play[0], opponent.state().play[0]) << "the clip of agent 0";
}

TEST_P(CpuCrowdTest, AnotherPaceIsRefused) {
  Start start(device(), rollingGround(), sceneOf(16, 1, 1, Controller::clip), 60);
  validation::HerdFacts slower = start.facts();
  for (size_t speed = 3; speed < slower.clips.heads.size(); speed += 4) slower.clips.heads[speed] *= 1.01f;
  EXPECT_EQ(refusedStages(slower, start, 60), "clip swing ");
}

TEST_P(CpuCrowdTest, AnotherFrameIsRefused) {
  Start start(device(), rollingGround(), sceneOf(16, 1, 1, Controller::clip), 60);
  validation::HerdFacts bent = start.facts();
  for (size_t i = 0; i < bent.clips.rows.size(); i += 12 * size_t(bent.clips.joints))
    bent.clips.rows[i] += 1e-3f;
  EXPECT_EQ(refusedStages(bent, start, 5), "swing pose ");
}

TEST_P(CpuCrowdTest, ThreadsChangeNoBit) {
  Start start(device(), rollingGround(), 700, 60);
  CpuCrowd one(start.facts(), start.state, options(1)), three(start.facts(), start.state, options(3));
  for (uint64_t n = start.crowd.tick() + 1, i = 0; i < 60; ++n, ++i) {
    one.tick(n);
    three.tick(n);
  }
  const HerdState a = one.state(), b = three.state();
  EXPECT_EQ(a.body, b.body);
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.arc, b.arc);
  EXPECT_EQ(a.chain, b.chain);
  EXPECT_EQ(a.tip, b.tip);
  EXPECT_EQ(a.miss, b.miss);
  EXPECT_EQ(a.pose, b.pose);
  EXPECT_NE(a.body, start.state.body);
}

// The legs that lift in a tick, from that tick's bodies and the steps before it.
TEST_P(CpuCrowdTest, BeginsStepsOnTheirOwnAsInATick) {
  Start start(device(), rollingGround(), 300, 60);
  const uint64_t n = start.crowd.tick() + 1;
  CpuCrowd whole(start.facts(), start.state, options());
  whole.tick(n);
  const HerdState after = whole.state();
  HerdState between = after;
  between.step = start.state.step;
  between.arc = start.state.arc;
  CpuCrowd alone(start.facts(), between, options());
  const size_t legs = start.facts().rig.legs.size(), count = 299 * legs + 3;
  alone.beginSteps(n, count);
  const HerdState begun = alone.state();
  const auto record = [](const std::vector<float>& records, size_t leg) {
    return std::vector<float>(records.begin() + ptrdiff_t(8 * leg), records.begin() + ptrdiff_t(8 * leg + 8));
  };
  size_t lifted = 0;
  for (size_t leg = 0; leg < 300 * legs; ++leg) {
    if (leg >= count) {
      EXPECT_EQ(record(begun.arc, leg), record(start.state.arc, leg)) << leg;
      continue;
    }
    EXPECT_EQ(begun.step[8 * leg + 3], float(n - 1)) << leg;
    const auto lifts = uint32_t(after.gait[leg / legs * 8 + 1]);
    if ((lifts >> leg % legs & 1) == 0) continue;
    ++lifted;
    EXPECT_EQ(record(begun.step, leg), record(after.step, leg)) << leg;
    EXPECT_EQ(record(begun.arc, leg), record(after.arc, leg)) << leg;
  }
  EXPECT_GT(lifted, 20u);
}

TEST_P(CpuCrowdTest, RefusesToBeginStepsThatNoLegHas) {
  Start start(device(), rollingGround(), 2, 1),
      clips(device(), rollingGround(), sceneOf(2, 1, 1, Controller::clip), 1);
  CpuCrowd opponent(start.facts(), start.state, options()), playing(clips.facts(), clips.state, options());
  EXPECT_THROW(opponent.beginSteps(2, 17), Error);
  EXPECT_THROW(playing.beginSteps(2, 1), Error);
}

TEST_P(CpuCrowdTest, ALostAgentLeavesItsBlockAlone) {
  Start start(device(), rollingGround(), 17, 60);
  CpuCrowd well(start.facts(), start.state, options());
  HerdState lost = start.state;
  lost.step[3 * 8 * 8] = std::numeric_limits<float>::quiet_NaN();  // of agent 3, where its first leg stands
  CpuCrowd ill(start.facts(), lost, options());
  for (uint64_t n = start.crowd.tick() + 1, i = 0; i < 40; ++n, ++i) {
    well.tick(n);
    ill.tick(n);
  }
  const HerdState a = well.state(), b = ill.state();
  for (size_t agent = 0; agent < 17; ++agent) {
    const size_t floats = a.chain.size() / 17;
    const auto chain = [&](const HerdState& state) {
      return std::vector<float>(state.chain.begin() + ptrdiff_t(agent * floats),
                                state.chain.begin() + ptrdiff_t((agent + 1) * floats));
    };
    EXPECT_EQ(agent != 3, chain(a) == chain(b)) << agent;
  }
}

TEST_P(CpuCrowdTest, ABrokenOneIsRefused) {
  Start start(device(), rollingGround(), 16, 90);
  validation::HerdFacts slower = start.facts();
  slower.parameters.heightBlend *= 1.02f;
  EXPECT_EQ(refusedStages(slower, start, 20), "body ");
  std::vector<float> records = implOf(start.crowd).kindOf(0).rigRecords;
  records[0] += 1e-3f;  // a root
  const validation::HerdFacts crooked{start.facts().rig, start.terrain, start.facts().parameters, records,
                                      start.facts().ik};
  EXPECT_EQ(refusedStages(crooked, start, 20), "ik pose ");
}

TEST_P(CpuCrowdTest, RefusesWhatItCannotWalk) {
  Start start(device(), rollingGround(), 4, 1);
  HerdState torn = start.state;
  torn.step.pop_back();
  EXPECT_THROW(CpuCrowd(start.facts(), torn, options()), Error);
  EXPECT_THROW(CpuCrowd(start.facts(), start.state, options(0)), Error);
  validation::HerdFacts looping = start.facts();
  looping.controller = Controller::loop;
  EXPECT_THROW(CpuCrowd(looping, start.state, options()), Error);
  validation::HerdFacts compared = start.facts();
  compared.ik = crowd::ikPlanFor(Solver::fabrik);
  EXPECT_THROW(CpuCrowd(compared, start.state, options()), Error);
}

TEST_P(CpuCrowdTest, TellsWhatStagesTake) {
  Start start(device(), rollingGround(), 16, 1);
  CpuCrowd opponent(start.facts(), start.state, options());
  opponent.tick(start.crowd.tick() + 1);
  for (const cpu_crowd::StageSeconds& stage : opponent.stageSeconds())
    EXPECT_EQ(stage.seconds, 0) << stage.stage;
  opponent.timeStages(true);
  opponent.tick(start.crowd.tick() + 2);
  std::string names;
  for (const cpu_crowd::StageSeconds& stage : opponent.stageSeconds()) {
    names += stage.stage + " ";
    EXPECT_GT(stage.seconds, 0) << stage.stage;
  }
  EXPECT_EQ(names, "navigate body gait foothold swing ik pose ");
  EXPECT_GT(opponent.bytesAnAgent(), 4u * 16 * 8);
}

INSTANTIATE_TEST_SUITE_P(, CpuCrowdTest, ::testing::Values(Width::scalar, Width::simd),
                         [](const auto& tested) { return tested.param == Width::simd ? "simd" : "scalar"; });

}  // namespace
}  // namespace skitter::test

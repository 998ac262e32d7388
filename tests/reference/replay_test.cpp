#include "validation/replay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "reference_herd.h"
#include "skitter/error.h"
#include "skitter/records.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

using validation::Replay;
using validation::StageResult;

TEST(Replay, referenceAgreesWithItself) {
  ReferenceHerd herd(roughField(), 24, 1);
  Replay replay = herd.replay();
  for (int i = 0; i < 240; ++i) {
    const HerdState before = herd.state();
    herd.tick();
    replay.tick(herd.ticks(), before, herd.state());
  }
  const auto results = replay.results();
  EXPECT_TRUE(replay.pass()) << validation::table(results);
  const std::vector<const char*> names = {"navigate", "body", "gait", "foothold",
                                          "swing",    "ik",   "pose", "measure"};
  ASSERT_EQ(results.size(), names.size());
  for (size_t s = 0; s < names.size(); ++s) {
    EXPECT_EQ(results[s].name, names[s]);
    EXPECT_EQ(results[s].ties, 0u) << names[s];
  }
  EXPECT_EQ(results[0].samples, 24u * 240);
  EXPECT_EQ(results[4].samples, 8u * 24 * 240);
  EXPECT_GT(results[3].samples, 1000u);
  EXPECT_LT(results[3].samples, 8u * 24 * 240);
}

std::vector<std::string> namesOf(const std::vector<StageResult>& results) {
  std::vector<std::string> names;
  for (const StageResult& result : results) names.push_back(result.name);
  return names;
}

TEST(Replay, samplesAgentsInTurn) {
  EXPECT_EQ(validation::sampleAt(7, 1, 1023, 1024).stride, 1u);
  std::set<uint32_t> firsts;
  for (uint64_t n = 1; n <= 100; ++n) {
    const AgentSample sample = validation::sampleAt(7, n, 4100, 1024);
    ASSERT_EQ(sample.stride, 5u);
    ASSERT_LT(sample.first, 5u);
    firsts.insert(sample.first);
  }
  EXPECT_EQ(firsts.size(), 5u);
}

TEST(Replay, leavesOutWhatAStateHasNot) {
  ReferenceHerd herd(roughField(), 2);
  Replay replay = herd.replay();
  HerdState before = herd.state();
  herd.tick();
  HerdState after = herd.state();
  for (HerdState* state : {&before, &after}) {
    state->pose.clear();
    state->metric.clear();
  }
  const std::vector<std::string> few = {"navigate", "body", "gait", "foothold", "swing", "ik"};
  EXPECT_EQ(namesOf(replay.results()).back(), "footfall") << "nothing is known to be left out yet";
  EXPECT_FALSE(replay.pass());
  replay.tick(herd.ticks(), before, after);
  EXPECT_TRUE(replay.pass());
  EXPECT_EQ(replay.results()[5].samples, 16u);
  EXPECT_EQ(namesOf(replay.results()), few);
  // One tick that has them is enough.
  before = herd.state();
  herd.tick();
  replay.tick(herd.ticks(), before, herd.state());
  EXPECT_TRUE(replay.pass());
  EXPECT_EQ(namesOf(replay.results()).size(), few.size() + 2);
}

TEST(Replay, wrongSizesAreErrors) {
  ReferenceHerd herd(roughField(), 2);
  Replay replay = herd.replay();
  HerdState cut = herd.state();
  cut.chain.pop_back();
  EXPECT_THROW(replay.tick(1, cut, herd.state()), Error);
  EXPECT_THROW(replay.tick(1, herd.state(), cut), Error);
}

// Then ik is held against the steps.
TEST(Replay, feetMayBeAbsent) {
  ReferenceHerd herd(roughField(), 2);
  for (int i = 0; i < 40; ++i) herd.tick();
  HerdState before = herd.state();
  herd.tick();
  HerdState after = herd.state();
  for (HerdState* state : {&before, &after}) state->foot.clear();
  Replay replay = herd.replay();
  replay.tick(herd.ticks(), before, after);
  EXPECT_TRUE(replay.pass());
  EXPECT_EQ(replay.results()[4].name, "ik");
  EXPECT_EQ(replay.results()[4].samples, 16u);
  after.miss[0] += 1e-3f;
  Replay another = herd.replay();
  another.tick(herd.ticks(), before, after);
  EXPECT_FALSE(another.results()[4].pass);
}

TEST(Replay, metricsMayBeAbsent) {
  ReferenceHerd herd(roughField(), 2);
  Replay replay = herd.replay();
  HerdState before = herd.state();
  herd.tick();
  HerdState after = herd.state();
  before.metric.clear();
  after.metric.clear();
  replay.tick(1, before, after);
  EXPECT_EQ(namesOf(replay.results()).back(), "pose");
  EXPECT_TRUE(replay.pass());
}

// Each case spoils one value that one stage wrote. That stage must fail. Stages before it must not; stages
// after it read the spoilt value as their input and so did not compute what now follows from it.
struct Fault {
  const char* name;
  size_t stage;
  void (*spoil)(HerdState& after);
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

class ReplayFault : public testing::TestWithParam<Fault> {
 protected:
  std::vector<StageResult> replay(const std::function<void(HerdState&)>& spoil) {
    // Long enough for the legs to be in mid step, up to a tick in which leg 0 of agent 0 lifts.
    ReferenceHerd herd(roughField(), 1);
    HerdState before;
    do {
      before = herd.state();
      herd.tick();
    } while (herd.ticks() < 60 || (static_cast<uint32_t>(herd.state().gait[1]) & 1u) == 0);
    HerdState after = herd.state();
    spoil(after);
    Replay checker = herd.replay();
    checker.tick(herd.ticks(), before, after);
    return checker.results();
  }
};

TEST_P(ReplayFault, isFound) {
  const auto clean = replay([](HerdState&) {});
  for (const StageResult& result : clean) ASSERT_TRUE(result.pass) << validation::table(clean);
  const auto results = replay(GetParam().spoil);
  for (size_t s = 0; s < GetParam().stage; ++s) EXPECT_TRUE(results[s].pass) << results[s].name;
  EXPECT_FALSE(results[GetParam().stage].pass) << validation::table(results);
  EXPECT_FALSE(results[GetParam().stage].worst.empty());
}

constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    everyQuantity, ReplayFault,
    testing::Values(Fault{"goalTarget", 0, [](HerdState& s) { s.goal[0] += 0.01f; }},
                    Fault{"goalKind", 0, [](HerdState& s) { s.goal[6] = 1; }},
                    Fault{"desiredVelocity", 0, [](HerdState& s) { s.steer[0] += 1e-3f; }},
                    Fault{"desiredVelocityNan", 0, [](HerdState& s) { s.steer[1] = notANumber; }},
                    Fault{"localX", 1, [](HerdState& s) { s.body[0] += 1e-3f; }},
                    Fault{"height", 1, [](HerdState& s) { s.body[1] += 1e-3f; }},
                    Fault{"heading", 1, [](HerdState& s) { s.body[4] += 1e-3f; }},
                    Fault{"tile", 1, [](HerdState& s) { s.body[3] += 1; }},
                    Fault{"speed", 1, [](HerdState& s) { s.body[6] += 1e-3f; }},
                    Fault{"orientation", 1, [](HerdState& s) { s.body[8] += 1e-3f; }},
                    Fault{"orientationSign", 1,
                          [](HerdState& s) {
                            for (size_t i = 8; i < 12; ++i) s.body[i] = -s.body[i];
                          }},
                    Fault{"turnRate", 1, [](HerdState& s) { s.body[12] += 1e-2f; }},
                    Fault{"stillTime", 1, [](HerdState& s) { s.body[13] += 1e-3f; }},
                    Fault{"followFactor", 1, [](HerdState& s) { s.body[14] -= 1e-3f; }},
                    Fault{"surfaceSpeed", 1, [](HerdState& s) { s.body[15] += 1e-3f; }},
                    Fault{"bodyInfinite", 1, [](HerdState& s) { s.body[15] = INFINITY; }},
                    Fault{"phase", 2, [](HerdState& s) { s.gait[0] += 1e-4f; }},
                    Fault{"liftMask", 2, [](HerdState& s) { s.gait[1] -= 1; }},
                    Fault{"reaimMask", 2, [](HerdState& s) { s.gait[2] += 2; }},
                    Fault{"duration", 2, [](HerdState& s) { s.gait[3] += 1; }},
                    Fault{"halfStride", 2, [](HerdState& s) { s.gait[4] += 1e-4f; }},
                    Fault{"cycle", 2, [](HerdState& s) { s.gait[5] += 1e-4f; }},
                    Fault{"airMask", 2, [](HerdState& s) { s.gait[6] += 2; }},
                    Fault{"gaitNan", 2, [](HerdState& s) { s.gait[5] = notANumber; }},
                    Fault{"landing", 3, [](HerdState& s) { s.step[2] += 1e-3f; }},
                    Fault{"landingHeight", 3, [](HerdState& s) { s.step[1] += 1e-3f; }},
                    Fault{"landingTile", 3, [](HerdState& s) { s.step[7] += 1; }},
                    Fault{"liftOff", 3, [](HerdState& s) { s.step[4] += 1e-3f; }},
                    Fault{"liftVector", 3, [](HerdState& s) { s.arc[1] += 1e-3f; }},
                    Fault{"firstTick", 3, [](HerdState& s) { s.step[3] += 1; }},
                    Fault{"startTangent", 3, [](HerdState& s) { s.arc[5] += 1e-3f; }},
                    Fault{"stepDuration", 3, [](HerdState& s) { s.step[7] += shared::STEP_TICK; }},
                    Fault{"stepOfAPlantedLeg", 3, [](HerdState& s) { s.step[8 + 1] += 1e-6f; }},
                    Fault{"arcOfAPlantedLeg", 3, [](HerdState& s) { s.arc[8 + 1] += 1e-6f; }},
                    Fault{"arcNan", 3, [](HerdState& s) { s.arc[4] = notANumber; }},
                    Fault{"stepNan", 3, [](HerdState& s) { s.step[4] = notANumber; }},
                    Fault{"footTarget", 4, [](HerdState& s) { s.foot[5] += 1e-3f; }},
                    Fault{"progress", 4, [](HerdState& s) { s.foot[3] += 1e-3f; }},
                    Fault{"footNan", 4, [](HerdState& s) { s.foot[0] = notANumber; }},
                    Fault{"directions", 5, [](HerdState& s) { s.chain[0] += 1e-2f; }},
                    Fault{"tip", 5, [](HerdState& s) { s.tip[0] += 1e-3f; }},
                    Fault{"reachError", 5, [](HerdState& s) { s.tip[3] += 1e-3f; }},
                    Fault{"miss", 5, [](HerdState& s) { s.miss[0] += 1e-3f; }},
                    Fault{"missNan", 5, [](HerdState& s) { s.miss[3] = notANumber; }},
                    Fault{"tipNan", 5, [](HerdState& s) { s.tip[5] = notANumber; }},
                    Fault{"chainNan", 5, [](HerdState& s) { s.chain[3] = notANumber; }},
                    Fault{"bodyRotation", 6, [](HerdState& s) { s.pose[0] += 1e-3f; }},
                    Fault{"bodyOffset", 6, [](HerdState& s) { s.pose[4] += 1e-3f; }},
                    Fault{"boneRotation", 6, [](HerdState& s) { s.pose[8 * 7 + 2] += 1e-3f; }},
                    Fault{"bonePosition", 6, [](HerdState& s) { s.pose[8 * 32 + 5] += 1e-3f; }},
                    Fault{"poseNan", 6, [](HerdState& s) { s.pose[8 * 5 + 6] = notANumber; }},
                    Fault{"ticks", 7, [](HerdState& s) { s.metric[0] += 1; }},
                    Fault{"planted", 7, [](HerdState& s) { s.metric[1] += 1; }},
                    Fault{"stays", 7, [](HerdState& s) { s.metric[2] += 1; }},
                    Fault{"skates", 7, [](HerdState& s) { s.metric[3] += 1; }},
                    Fault{"finishedSlip", 7, [](HerdState& s) { s.metric[4] += 1e-3f; }},
                    Fault{"finishedStances", 7, [](HerdState& s) { s.metric[5] += 1; }},
                    Fault{"largestError", 7, [](HerdState& s) { s.metric[6] += 1e-3f; }},
                    Fault{"largestViolation", 7, [](HerdState& s) { s.metric[7] += 1e-3f; }},
                    Fault{"penetration", 7, [](HerdState& s) { s.metric[8] += 1e-3f; }},
                    Fault{"penetrationBeyond", 7, [](HerdState& s) { s.metric[9] += 1e-3f; }},
                    Fault{"floating", 7, [](HerdState& s) { s.metric[10] += 1e-3f; }},
                    Fault{"floatingBeyond", 7, [](HerdState& s) { s.metric[11] += 1e-3f; }},
                    Fault{"depth", 7, [](HerdState& s) { s.metric[12] += 1e-3f; }},
                    Fault{"deepest", 7, [](HerdState& s) { s.metric[13] += 1e-3f; }},
                    Fault{"violations", 7, [](HerdState& s) { s.metric[14] += 1; }},
                    Fault{"pairs", 7, [](HerdState& s) { s.metric[16] += 1; }},
                    Fault{"crossings", 7, [](HerdState& s) { s.metric[17] += 1; }},
                    Fault{"supported", 7, [](HerdState& s) { s.metric[18] += 1; }},
                    Fault{"unstable", 7, [](HerdState& s) { s.metric[19] += 1; }},
                    Fault{"margin", 7, [](HerdState& s) { s.metric[20] += 1e-3f; }},
                    Fault{"leastMargin", 7, [](HerdState& s) { s.metric[21] += 1e-3f; }},
                    Fault{"footJerk", 7, [](HerdState& s) { s.metric[24] += 100; }},
                    Fault{"footPath", 7, [](HerdState& s) { s.metric[25] += 1; }},
                    Fault{"bodyJerk", 7, [](HerdState& s) { s.metric[26] += 100; }},
                    Fault{"bodyPath", 7, [](HerdState& s) { s.metric[27] += 1; }},
                    Fault{"bodyTrail", 7, [](HerdState& s) { s.watch[0] += 1e-4f; }},
                    Fault{"tipTrail", 7, [](HerdState& s) { s.watch[13] += 1e-4f; }},
                    Fault{"slip", 7, [](HerdState& s) { s.watch[15] += 1e-3f; }},
                    Fault{"firstDifference", 7, [](HerdState& s) { s.watch[16] += 1e-4f; }},
                    Fault{"path", 7, [](HerdState& s) { s.watch[19] += 1e-4f; }},
                    Fault{"secondDifference", 7, [](HerdState& s) { s.watch[21] += 1e-4f; }},
                    Fault{"squares", 7, [](HerdState& s) { s.watch[23] += 1e-3f; }},
                    Fault{"metricNan", 7, [](HerdState& s) { s.metric[4] = notANumber; }}),
    [](const auto& fault) { return std::string(fault.param.name); });

// A spoilt limit or a lost bone cannot hide behind a tie.
TEST_F(ReplayFault, brokenLimitIsNamed) {
  const auto results = replay([](HerdState& s) { s.chain[1] = 0.9f; });
  EXPECT_FALSE(results[5].pass);
  EXPECT_NE(results[5].worst.find("limit violation"), std::string::npos) << results[5].worst;
}

TEST(Replay, saysWhereTheJointsShouldBe) {
  ReferenceHerd herd(roughField(), 1);
  for (int i = 0; i < 60; ++i) herd.tick();
  HerdState before = herd.state();
  herd.tick();
  HerdState after = herd.state();
  // Without tips only the joints can differ.
  for (HerdState* state : {&before, &after}) state->tip.clear();
  for (float& direction : after.chain) direction *= 1 - 5e-7f;
  Replay replay = herd.replay();
  replay.tick(herd.ticks(), before, after);
  const StageResult ik = replay.results()[5];
  EXPECT_TRUE(ik.pass) << ik.why;
  EXPECT_EQ(ik.worst.find("joint positions / reach: "), 0u) << ik.worst;
  EXPECT_EQ(ik.worst.find("(0, 0, 0, 0)"), std::string::npos) << ik.worst;
}

// A float has so many digits, wherever its target is.
TEST(Replay, aFarTargetIsReachedForAllTheSame) {
  ReferenceHerd herd(roughField(), 1);
  for (int i = 0; i < 60; ++i) herd.tick();
  const HerdState before = herd.state();
  herd.tick();
  HerdState after = herd.state();
  const validation::HerdFacts facts = herd.facts();
  const validation::Setting setting = validation::settingOf(facts, facts.terrain);
  reference::Foot foot = validation::footOf(after, 0);
  foot.target.y -= 567.8;
  validation::putFoot(after, 0, foot);
  const reference::Chain chain =
      reference::ik(setting.tuning, setting.creature.limbs[0], validation::bodyOf(after, 0),
                    validation::footOf(after, 0), validation::chainOf(before, 0, herd.bones()), setting.ik);
  validation::putChain(after, 0, herd.bones(), chain);
  validation::putMiss(after, 0, 0, herd.legs(), herd.ticks(), chain.miss);
  const auto ik = [&] {
    Replay replay = herd.replay();
    replay.tick(herd.ticks(), before, after);
    return replay.results()[5];
  };
  EXPECT_TRUE(ik().pass) << ik().why;
  after.tip[3] += 0.01f;
  EXPECT_FALSE(ik().pass);
}

// A window whose path is the least that counts adds all of its sums or nothing, and is a tie where it did the
// other.
TEST(Replay, aCloseWindowCountsWholeOrNotAtAll) {
  constexpr int closing = 27;  // the first tick in which windows of 24 ticks close
  const auto longestOf = [](const ReferenceHerd& herd) {
    reference::TipTrail longest;
    for (const reference::TipTrail& tip : validation::watchedOf(herd.state(), 0, herd.legs()).tips)
      if (tip.path > longest.path) longest = tip;
    return longest;
  };
  ReferenceHerd first(roughField(), 1);
  for (int i = 0; i < closing; ++i) first.tick();
  ASSERT_GT(longestOf(first).path, 0);

  ReferenceHerd herd(roughField(), 1);
  herd.parameters().jerkPath = static_cast<float>(longestOf(first).path);
  for (int i = 1; i < closing; ++i) herd.tick();
  const HerdState before = herd.state();
  herd.tick();
  HerdState after = herd.state();
  const auto measure = [&] {
    Replay replay = herd.replay();
    replay.tick(closing, before, after);
    return replay.results()[7];
  };
  EXPECT_TRUE(measure().pass) << measure().why;
  EXPECT_EQ(measure().ties, 0u);

  const reference::TipTrail longest = longestOf(herd);
  float &jerk = after.metric[24], &squaredPath = after.metric[25];
  const bool counted = squaredPath > 0;
  jerk = counted ? 0 : static_cast<float>(std::pow(24, 5) * longest.jerk);
  squaredPath = counted ? 0 : static_cast<float>(longest.path * longest.path);
  EXPECT_TRUE(measure().pass) << measure().why;
  EXPECT_EQ(measure().ties, 1u);
  squaredPath = 1.01f * squaredPath + 0.01f;
  EXPECT_FALSE(measure().pass);
}

TEST(Replay, saysWhyAStageFailed) {
  validation::Judge judge("stage");
  EXPECT_FALSE(judge.result().pass);
  EXPECT_EQ(judge.result().why, "no samples");
  judge.keep();
  EXPECT_TRUE(judge.result().pass);
  validation::Sample bad;
  bad.compare("quantity", 2, 1, {1, 0, 0, 0}, {3, 0, 0, 0});
  judge.add(5, 6, 1, bad);
  const std::string why =
      "beyond the tolerance: quantity: tick 5, agent 6, leg 1, expected (1, 0, 0, 0), got (3, 0, 0, 0)";
  EXPECT_EQ(judge.result().why, why);
  EXPECT_NE(validation::table({judge.result()}).find("FAIL\n           " + why + "\n"), std::string::npos);
}

TEST(Replay, worstIsRelativeToItsOwnTolerance) {
  validation::Judge judge("stage");
  validation::Sample a, b;
  a.compare("coarse", 0.5, 1, {}, {});
  b.compare("fine", 0.01, 0.005, {}, {});
  judge.add(3, 7, 2, a);
  judge.add(4, 8, 3, b);
  const StageResult result = judge.result();
  EXPECT_FALSE(result.pass);
  EXPECT_EQ(result.maxError, 0.01);
  EXPECT_EQ(result.tolerance, 0.005);
  EXPECT_NE(result.worst.find("fine: tick 4, agent 8, leg 3"), std::string::npos);
}

}  // namespace
}  // namespace skitter::test

#include "validation/replay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <type_traits>

#include "cpu_reference/fields.h"
#include "gait_maps.h"
#include "reference_herd.h"
#include "skitter/error.h"
#include "skitter/records.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

using validation::Replay;
using validation::StageResult;

std::vector<std::string> namesOf(const std::vector<StageResult>& results) {
  std::vector<std::string> names;
  for (const StageResult& result : results) names.push_back(result.name);
  return names;
}

StageResult resultOf(const std::vector<StageResult>& results, const std::string& stage) {
  const auto found = std::ranges::find(results, stage, &StageResult::name);
  if (found == results.end()) throw std::runtime_error("replay has no result of " + stage);
  return *found;
}

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
  for (const StageResult& result : results) EXPECT_EQ(result.ties, 0u) << result.name;
  EXPECT_EQ(resultOf(results, "navigate").samples, 24u * 240);
  EXPECT_EQ(resultOf(results, "swing").samples, 8u * 24 * 240);
  EXPECT_GT(resultOf(results, "foothold").samples, 1000u);
  EXPECT_LT(resultOf(results, "foothold").samples, 8u * 24 * 240);
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
  std::vector<std::string> few;
  for (const validation::CheckedStage& checked : validation::checkedStages(Controller::adaptive)) {
    using enum crowd::StageId;
    if (checked.stage != avoid && checked.stage != adapt && checked.stage != react && checked.stage != pose &&
        checked.stage != measure && checked.stage != footfall)
      few.emplace_back(nameOf(checked.stage));
  }
  EXPECT_EQ(namesOf(replay.results()).back(), "footfall") << "nothing is known to be left out yet";
  EXPECT_FALSE(replay.pass());
  replay.tick(herd.ticks(), before, after);
  EXPECT_TRUE(replay.pass());
  EXPECT_EQ(resultOf(replay.results(), "ik").samples, 16u);
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
  EXPECT_EQ(resultOf(replay.results(), "ik").samples, 16u);
  after.miss[0] += 1e-3f;
  Replay another = herd.replay();
  another.tick(herd.ticks(), before, after);
  EXPECT_FALSE(resultOf(another.results(), "ik").pass);
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
  const std::vector<std::string> names = namesOf(replay.results());
  EXPECT_EQ(std::ranges::count(names, "pose"), 1);
  EXPECT_EQ(std::ranges::count(names, "measure"), 0);
  EXPECT_TRUE(replay.pass());
}

// Each case spoils one value that one stage wrote. That stage must fail. Stages before it must not; stages
// after it read the spoilt value as their input and so did not compute what now follows from it.
struct Fault {
  std::string name, stage;
  std::function<void(HerdState& after)> spoil;

  bool isOfOneWhoAdapts() const { return stage == "adapt"; }
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

class ReplayFault : public testing::TestWithParam<Fault> {
 protected:
  std::vector<StageResult> replay(const std::function<void(HerdState&)>& spoil, bool adapts = false) {
    // Long enough for the legs to be in mid step, up to a tick in which leg 0 of agent 0 lifts.
    ReferenceHerd herd(roughField(), 1);
    if (adapts) {
      herd.adapt(oneLegMap(spiderCreature()));
      herd.state().hurt[1] = 1 << 3;  // leg 3 is stuck
    }
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
  const bool adapts = GetParam().isOfOneWhoAdapts();
  const auto clean = replay([](HerdState&) {}, adapts);
  for (const StageResult& result : clean) ASSERT_TRUE(result.pass) << validation::table(clean);
  for (const StageResult& result : replay(GetParam().spoil, adapts)) {
    if (result.name != GetParam().stage) {
      EXPECT_TRUE(result.pass) << result.name;
      continue;
    }
    EXPECT_FALSE(result.pass) << result.maxError << " of " << result.tolerance;
    EXPECT_FALSE(result.worst.empty());
    return;
  }
  FAIL() << "replay has no result of " << GetParam().stage;
}

constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();

// Every field of a record, in the first agent's, leg's or entry's.
std::vector<Fault> fieldFaults() {
  // How much is wrong where 1e-3 is not near the tolerance.
  const std::map<std::string, float> amounts = {{"gait_phase", 1e-4f},    {"gait_halfStride", 1e-4f},
                                                {"gait_cycle", 1e-4f},    {"body_turnRate", 1e-2f},
                                                {"metric_footJerk", 100}, {"metric_footPath", 1},
                                                {"metric_bodyJerk", 100}, {"metric_bodyPath", 1}};
  std::vector<Fault> faults;
  const auto add = [&](const char* record, const char* stage, auto buffer, const char* field, size_t first,
                       bool isMask) {
    const std::string name = std::string(record) + "_" + field;
    const auto found = amounts.find(name);
    const float amount = found == amounts.end() ? 1e-3f : found->second;
    faults.push_back({name, stage, [=](HerdState& state) {
                        float& value = (state.*buffer)[first];
                        value =
                            isMask ? static_cast<float>(static_cast<uint32_t>(value) ^ 2u) : value + amount;
                      }});
  };
#define ADD(record, stage, type, name, place) \
  add(#record, stage, &HerdState::record, #name, place, std::is_same_v<type, uint32_t>);
#define GOAL(type, name, initial, place, roundings) ADD(goal, "navigate", type, name, place)
#define BODY(type, name, initial, place, roundings) ADD(body, "body", type, name, place)
#define GAIT(type, name, initial, place, roundings) ADD(gait, "gait", type, name, place)
#define STEP(type, name, initial, place, roundings) ADD(step, "foothold", type, name, place)
#define ARC(type, name, initial, place, roundings) ADD(arc, "foothold", type, name, place)
#define FOOT(type, name, initial, place, roundings) ADD(foot, "swing", type, name, place)
#define TIP(type, name, initial, place, roundings) ADD(tip, "ik", type, name, place)
#define POSE(type, name, initial, place, roundings) ADD(pose, "pose", type, name, place)
#define METRIC(type, name, initial, place, roundings) ADD(metric, "measure", type, name, place)
#define TRAIL(type, name, initial, place, roundings) ADD(watch, "measure", type, name, place)
#define SEARCH(type, name, initial, place, roundings) ADD(search, "adapt", type, name, place)
  SKITTER_GOAL_FIELDS(GOAL)
  SKITTER_BODY_FIELDS(BODY)
  SKITTER_GAIT_FIELDS(GAIT)
  SKITTER_STEP_FIELDS(STEP)
  SKITTER_ARC_FIELDS(ARC)
  SKITTER_FOOT_FIELDS(FOOT)
  SKITTER_TIP_FIELDS(TIP)
  SKITTER_POSE_FIELDS(POSE)
  SKITTER_METRIC_FIELDS(METRIC)
  SKITTER_TRAIL_FIELDS(TRAIL)
  SKITTER_SEARCH_FIELDS(SEARCH)
  return faults;
}

INSTANTIATE_TEST_SUITE_P(everyField, ReplayFault, testing::ValuesIn(fieldFaults()),
                         [](const auto& fault) { return fault.param.name; });

INSTANTIATE_TEST_SUITE_P(
    packedAndBroken, ReplayFault,
    testing::Values(Fault{"goalKind", "navigate", [](HerdState& s) { s.goal[6] = 1; }},
                    Fault{"desiredVelocity", "navigate", [](HerdState& s) { s.steer[0] += 1e-3f; }},
                    Fault{"desiredVelocityNan", "navigate", [](HerdState& s) { s.steer[1] = notANumber; }},
                    Fault{"tile", "body", [](HerdState& s) { s.body[3] += 1; }},
                    Fault{"orientationSign", "body",
                          [](HerdState& s) {
                            for (size_t i = 8; i < 12; ++i) s.body[i] = -s.body[i];
                          }},
                    Fault{"bodyInfinite", "body", [](HerdState& s) { s.body[15] = INFINITY; }},
                    Fault{"gaitNan", "gait", [](HerdState& s) { s.gait[5] = notANumber; }},
                    Fault{"idleLegs", "gait", [](HerdState& s) { s.gait[7] = 2; }},
                    Fault{"lostBone", "pose", [](HerdState& s) { s.pose[8 * 7 + 7] = 1; }},
                    Fault{"landingZ", "foothold", [](HerdState& s) { s.step[2] += 1e-3f; }},
                    Fault{"landingHeight", "foothold", [](HerdState& s) { s.step[1] += 1e-3f; }},
                    Fault{"landingTile", "foothold", [](HerdState& s) { s.step[7] += 1; }},
                    Fault{"stepDuration", "foothold", [](HerdState& s) { s.step[7] += shared::STEP_TICK; }},
                    Fault{"stepOfAPlantedLeg", "foothold", [](HerdState& s) { s.step[8 + 1] += 1e-6f; }},
                    Fault{"arcOfAPlantedLeg", "foothold", [](HerdState& s) { s.arc[8 + 1] += 1e-6f; }},
                    Fault{"arcNan", "foothold", [](HerdState& s) { s.arc[4] = notANumber; }},
                    Fault{"stepNan", "foothold", [](HerdState& s) { s.step[4] = notANumber; }},
                    Fault{"footNan", "swing", [](HerdState& s) { s.foot[0] = notANumber; }},
                    Fault{"directions", "ik", [](HerdState& s) { s.chain[0] += 1e-2f; }},
                    Fault{"miss", "ik", [](HerdState& s) { s.miss[0] += 1e-3f; }},
                    Fault{"missNan", "ik", [](HerdState& s) { s.miss[3] = notANumber; }},
                    Fault{"tipNan", "ik", [](HerdState& s) { s.tip[5] = notANumber; }},
                    Fault{"chainNan", "ik", [](HerdState& s) { s.chain[3] = notANumber; }},
                    Fault{"boneRotation", "pose", [](HerdState& s) { s.pose[8 * 7 + 2] += 1e-3f; }},
                    Fault{"bonePosition", "pose", [](HerdState& s) { s.pose[8 * 32 + 5] += 1e-3f; }},
                    Fault{"poseNan", "pose", [](HerdState& s) { s.pose[8 * 5 + 6] = notANumber; }},
                    Fault{"largestViolation", "measure", [](HerdState& s) { s.metric[7] += 1e-3f; }},
                    Fault{"tipTrail", "measure", [](HerdState& s) { s.watch[13] += 1e-4f; }},
                    Fault{"slip", "measure", [](HerdState& s) { s.watch[15] += 1e-3f; }},
                    Fault{"metricNan", "measure", [](HerdState& s) { s.metric[4] = notANumber; }}),
    [](const auto& fault) { return fault.param.name; });

INSTANTIATE_TEST_SUITE_P(
    ofOneWhoAdapts, ReplayFault,
    testing::Values(Fault{"searchDoes", "adapt", [](HerdState& s) { s.search[2] = shared::SEARCH_SETTLED; }},
                    Fault{"searchTrials", "adapt", [](HerdState& s) { s.search[3] = 1; }},
                    Fault{"trialCandidate", "adapt", [](HerdState& s) { s.search[12] = 1; }},
                    Fault{"trialFitness", "adapt", [](HerdState& s) { s.search[51] = 1e-3f; }},
                    Fault{"searchUnused", "adapt", [](HerdState& s) { s.search[11] = 1e-3f; }},
                    Fault{"searchNan", "adapt", [](HerdState& s) { s.search[8] = notANumber; }},
                    Fault{"hurtGroups", "adapt", [](HerdState& s) { s.hurt[3] += 1; }},
                    Fault{"hurtShift", "adapt", [](HerdState& s) { s.hurt[9] += 1e-6f; }},
                    Fault{"hurtSpeed", "adapt", [](HerdState& s) { s.hurt[11] += 1e-6f; }},
                    Fault{"hurtGroup", "adapt", [](HerdState& s) { s.hurt[12] += 1; }},
                    Fault{"hurtLag", "adapt", [](HerdState& s) { s.hurt[13] += 1e-6f; }},
                    Fault{"hurtNeighbours", "adapt", [](HerdState& s) { s.hurt[14] += 1; }},
                    Fault{"hurtSlowness", "adapt", [](HerdState& s) { s.hurt[4 * 10 + 3] += 1e-6f; }},
                    Fault{"hurtNan", "adapt", [](HerdState& s) { s.hurt[8] = notANumber; }}),
    [](const auto& fault) { return fault.param.name; });

// A spoilt limit or a lost bone cannot hide behind a tie.
TEST_F(ReplayFault, brokenLimitIsNamed) {
  const auto results = replay([](HerdState& s) { s.chain[1] = 0.9f; });
  const StageResult ik = resultOf(results, "ik");
  EXPECT_FALSE(ik.pass);
  EXPECT_NE(ik.worst.find("limit violation"), std::string::npos) << ik.worst;
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
  const StageResult ik = resultOf(replay.results(), "ik");
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
    return resultOf(replay.results(), "ik");
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
    return resultOf(replay.results(), "measure");
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

// The agents of one size in a herd have numbers from some other than 0 on.
TEST(Replay, MessagesNumberAgentsAsTheirHerdDoes) {
  validation::Judge judge("stage", 20);
  validation::Sample bad;
  bad.compare("quantity", 2, 1, {}, {});
  judge.add(5, 6, 1, bad);
  EXPECT_NE(judge.result().why.find("quantity: tick 5, agent 26, leg 1"), std::string::npos);
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

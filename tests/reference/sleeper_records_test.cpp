// Every record of a sleeper stays as it is, to the bit, and whoever changes it is named.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "crowd/controller.h"
#include "reference_herd.h"
#include "skitter/records.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

using validation::Replay;
using validation::StageResult;

// Every record that a herd has between navigate and measure, and who writes it.
struct Record {
  const char* name;
  Controller controller;
  std::vector<float> HerdState::*records;
  const char* stage;
  size_t legs;  // 1: it is of the whole agent
};
void PrintTo(const Record& record, std::ostream* out) { *out << record.name; }

class SleepersRecord : public testing::TestWithParam<Record> {
 protected:
  // Two agents of made-up records, unlike anything that the stages compute, but asleep.
  static constexpr size_t agents = 2, legs = 8, bones = 4;
  HerdState asleep() const {
    const Controller controller = GetParam().controller;
    HerdState state;
    state.agents = agents;
    state.sleep = true;
    const auto fill = [](std::vector<float>& records, size_t count, int stride) {
      records.resize(4 * agents * count * static_cast<size_t>(stride));
      for (size_t i = 0; i < records.size(); ++i) records[i] = 0.001f * static_cast<float>(i % 977);
    };
    fill(state.goal, 1, shared::GOAL_STRIDE);
    fill(state.steer, 1, shared::STEER_STRIDE);
    fill(state.body, 1, shared::BODY_STRIDE);
    fill(state.gait, 1, shared::GAIT_STRIDE);
    fill(state.step, legs, shared::STEP_STRIDE);
    if (crowd::traitsOf(controller).aimsSteps) fill(state.arc, legs, shared::ARC_STRIDE);
    fill(state.foot, legs, shared::FOOT_STRIDE);
    fill(state.chain, legs, shared::chainStride(bones));
    fill(state.tip, legs, shared::TIP_STRIDE);
    if (crowd::traitsOf(controller).tellsMisses) fill(state.miss, 1, shared::missStride(legs));
    if (crowd::traitsOf(controller).playsClips) fill(state.play, 1, shared::PLAY_STRIDE);
    if (crowd::traitsOf(controller).playsClips) fill(state.pose, 1, shared::MATRIX_STRIDE);
    if (!crowd::traitsOf(controller).playsClips) fill(state.pose, 1 + legs * bones, shared::POSE_STRIDE);
    if (controller == Controller::planted) {
      fill(state.start, legs, shared::startStride(bones));
      fill(state.fix, legs * bones, shared::FIX_STRIDE);
    }
    if (controller == Controller::keyPoses) fill(state.spring, legs, shared::chainStride(bones));
    for (size_t agent = 0; agent < agents; ++agent) {
      validation::putGoal(state, agent, {});
      validation::putSteer(state, agent, {0, 0}, true);
      state.body[16 * agent + 13] = 5;
      validation::putGait(state, agent, {.cycle = 1.2});
    }
    return state;
  }
  Replay judge() const {
    const ReferenceHerd herd(flatField(), 1);
    validation::HerdFacts facts = herd.facts();
    facts.controller = GetParam().controller;
    facts.clips.joints = 1;
    facts.clips.bones = {-1, 0, 0, 0};
    facts.clips.legs.resize(4 * legs * (bones + 1));
    facts.keyPoses.records.resize(4 * legs * static_cast<size_t>(shared::keyStride(bones, 0)));
    return Replay(facts);
  }
};

TEST_P(SleepersRecord, staysAndIsNoSample) {
  Replay replay = judge();
  replay.tick(9, asleep(), asleep());
  for (const StageResult& result : replay.results()) {
    EXPECT_TRUE(result.pass) << result.name << ": " << result.why;
    EXPECT_EQ(result.samples, result.name == "navigate" ? agents : 0) << result.name;
  }
}

TEST_P(SleepersRecord, mustBeWhatItWasToTheBit) {
  HerdState before = asleep(), after = asleep();
  // The last float of the second agent's or, of those of legs, of its last leg but one's.
  const size_t legsHere = GetParam().legs, leg = legsHere > 1 ? legsHere - 2 : 0;
  const size_t each = (before.*GetParam().records).size() / agents / legsHere;
  float& was = (before.*GetParam().records)[(legsHere + leg + 1) * each - 1];
  float& is = (after.*GetParam().records)[(legsHere + leg + 1) * each - 1];
  const std::string place =
      "of a sleeper: tick 9, agent 1, leg " + std::to_string(legsHere > 1 ? static_cast<int>(leg) : -1) + ",";
  const float some = 0.25f, more = std::nextafter(some, 1.0f);
  for (const auto& [from, to] : {std::pair(some, more), {more, some}, {some, NAN}, {0.0f, -0.0f}}) {
    was = from, is = to;
    Replay replay = judge();
    replay.tick(9, before, after);
    for (const StageResult& result : replay.results()) {
      const bool writer = result.name == GetParam().stage;
      EXPECT_EQ(result.pass, !writer) << result.name << ": " << result.worst;
      EXPECT_EQ(result.worst.find(place) != std::string::npos, writer) << result.worst;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    everyRecord, SleepersRecord,
    testing::Values(Record{"adaptiveBody", Controller::adaptive, &HerdState::body, "body", 1},
                    Record{"adaptiveGait", Controller::adaptive, &HerdState::gait, "gait", 1},
                    Record{"adaptiveStep", Controller::adaptive, &HerdState::step, "foothold", 8},
                    Record{"adaptiveArc", Controller::adaptive, &HerdState::arc, "foothold", 8},
                    Record{"adaptiveFoot", Controller::adaptive, &HerdState::foot, "swing", 8},
                    Record{"adaptiveChain", Controller::adaptive, &HerdState::chain, "ik", 8},
                    Record{"adaptiveTip", Controller::adaptive, &HerdState::tip, "ik", 8},
                    Record{"adaptiveMiss", Controller::adaptive, &HerdState::miss, "ik", 1},
                    Record{"adaptivePose", Controller::adaptive, &HerdState::pose, "pose", 1},
                    Record{"loopBody", Controller::loop, &HerdState::body, "body", 1},
                    Record{"loopGait", Controller::loop, &HerdState::gait, "gait", 1},
                    Record{"loopFoot", Controller::loop, &HerdState::foot, "swing", 8},
                    Record{"loopChain", Controller::loop, &HerdState::chain, "ik", 8},
                    Record{"loopTip", Controller::loop, &HerdState::tip, "ik", 8},
                    Record{"loopMiss", Controller::loop, &HerdState::miss, "ik", 1},
                    Record{"loopPose", Controller::loop, &HerdState::pose, "pose", 1},
                    Record{"clipBody", Controller::clip, &HerdState::body, "body", 1},
                    Record{"clipPlay", Controller::clip, &HerdState::play, "clip", 1},
                    Record{"clipFoot", Controller::clip, &HerdState::foot, "swing", 8},
                    Record{"clipChain", Controller::clip, &HerdState::chain, "swing", 8},
                    Record{"clipTip", Controller::clip, &HerdState::tip, "swing", 8},
                    Record{"clipPose", Controller::clip, &HerdState::pose, "pose", 1},
                    Record{"plantedBody", Controller::planted, &HerdState::body, "body", 1},
                    Record{"plantedPlay", Controller::planted, &HerdState::play, "clip", 1},
                    Record{"plantedStep", Controller::planted, &HerdState::step, "swing", 8},
                    Record{"plantedFoot", Controller::planted, &HerdState::foot, "swing", 8},
                    Record{"plantedStart", Controller::planted, &HerdState::start, "swing", 8},
                    Record{"plantedChain", Controller::planted, &HerdState::chain, "ik", 8},
                    Record{"plantedTip", Controller::planted, &HerdState::tip, "ik", 8},
                    Record{"plantedFix", Controller::planted, &HerdState::fix, "ik", 8},
                    Record{"plantedPose", Controller::planted, &HerdState::pose, "pose", 1},
                    Record{"keyPosesBody", Controller::keyPoses, &HerdState::body, "body", 1},
                    Record{"keyPosesGait", Controller::keyPoses, &HerdState::gait, "gait", 1},
                    Record{"keyPosesFoot", Controller::keyPoses, &HerdState::foot, "swing", 8},
                    Record{"keyPosesChain", Controller::keyPoses, &HerdState::chain, "swing", 8},
                    Record{"keyPosesTip", Controller::keyPoses, &HerdState::tip, "swing", 8},
                    Record{"keyPosesSpring", Controller::keyPoses, &HerdState::spring, "swing", 8},
                    Record{"keyPosesPose", Controller::keyPoses, &HerdState::pose, "pose", 1}),
    [](const auto& param) { return std::string(param.param.name); });

}  // namespace
}  // namespace skitter::test

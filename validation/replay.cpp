#include "validation/replay.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "shared/ik_batch.h"
#include "shared/records.h"
#include "skitter/error.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/convert_clip.h"

namespace skitter::validation {
namespace {

struct Stage {
  const char* name;
  void (*check)(const Setting&, const Moment&, Judge&);
  std::vector<Kept> writes = {};  // that a sleeper keeps; none: it takes part in the stage as ever
};
using Stages = std::vector<Stage>;

namespace kept {
constexpr Kept body{&HerdState::body, "body of a sleeper", false};
constexpr Kept gait{&HerdState::gait, "gait of a sleeper", false};
constexpr Kept play{&HerdState::play, "play of a sleeper", false};
constexpr Kept pose{&HerdState::pose, "pose of a sleeper", false};
constexpr Kept step{&HerdState::step, "step of a sleeper", true};
constexpr Kept arc{&HerdState::arc, "arc of a sleeper", true};
constexpr Kept foot{&HerdState::foot, "foot of a sleeper", true};
constexpr Kept chain{&HerdState::chain, "chain of a sleeper", true};
constexpr Kept tip{&HerdState::tip, "tip of a sleeper", true};
constexpr Kept miss{&HerdState::miss, "miss of a sleeper", false};
constexpr Kept start{&HerdState::start, "start of a sleeper", true};
constexpr Kept fix{&HerdState::fix, "fix of a sleeper", true};
constexpr Kept spring{&HerdState::spring, "spring of a sleeper", true};
}  // namespace kept

const Stages& stagesOf(crowd::Controller controller) {
  static const Stages adaptive = {
      {"navigate", checkNavigate},         {"body", checkBody, {kept::body}},
      {"gait", checkGait, {kept::gait}},   {"foothold", checkFoothold, {kept::step, kept::arc}},
      {"swing", checkSwing, {kept::foot}}, {"ik", checkIk, {kept::chain, kept::tip, kept::miss}},
      {"pose", checkPose, {kept::pose}},   {"measure", checkMeasure},
      {"footfall", checkFootfall}};
  static const Stages loop = {{"navigate", checkNavigate},
                              {"body", checkBlindBody, {kept::body}},
                              {"gait", checkLoopGait, {kept::gait}},
                              {"swing", checkLoopSwing, {kept::foot}},
                              {"ik", checkIk, {kept::chain, kept::tip, kept::miss}},
                              {"pose", checkPose, {kept::pose}},
                              {"measure", checkMeasure},
                              {"footfall", checkFootfall}};
  static const Stages clip = {{"navigate", checkNavigate},
                              {"body", checkBlindBody, {kept::body}},
                              {"clip", checkClip, {kept::play}},
                              {"swing", checkClipSwing, {kept::foot, kept::chain, kept::tip}},
                              {"pose", checkClipPose, {kept::pose}},
                              {"measure", checkMeasure},
                              {"footfall", checkFootfall}};
  static const Stages planted = {{"navigate", checkNavigate},
                                 {"body", checkBlindBody, {kept::body}},
                                 {"clip", checkClip, {kept::play}},
                                 {"swing", checkPlantedSwing, {kept::step, kept::foot, kept::start}},
                                 {"ik", checkPlantedIk, {kept::chain, kept::tip, kept::fix}},
                                 {"pose", checkPlantedPose, {kept::pose}},
                                 {"measure", checkMeasure},
                                 {"footfall", checkFootfall}};
  static const Stages pose = {{"navigate", checkNavigate},
                              {"body", checkBlindBody, {kept::body}},
                              {"gait", checkPoseGait, {kept::gait}},
                              {"swing", checkPoseSwing, {kept::foot, kept::chain, kept::tip, kept::spring}},
                              {"pose", checkPose, {kept::pose}},
                              {"measure", checkMeasure},
                              {"footfall", checkFootfall}};
  switch (controller) {
    case crowd::Controller::loop:
      return loop;
    case crowd::Controller::clip:
      return clip;
    case crowd::Controller::planted:
      return planted;
    case crowd::Controller::pose:
      return pose;
    case crowd::Controller::adaptive:
      break;
  }
  return adaptive;
}

void expectSize(const char* what, size_t found, size_t expected) {
  if (found == expected) return;
  throw inputError(std::string(what) + ": found " + std::to_string(found) + " floats, expected " +
                   std::to_string(expected));
}

void expectSizes(const Setting& setting, const HerdState& state) {
  const size_t agents = state.agents;
  const auto expect = [&](const char* what, const std::vector<float>& buffer, size_t count, int stride) {
    expectSize(what, buffer.size(), 4 * agents * count * static_cast<size_t>(stride));
  };
  const size_t legs = static_cast<size_t>(setting.legs);
  expect("goal records", state.goal, 1, shared::GOAL_STRIDE);
  expect("steer records", state.steer, 1, shared::STEER_STRIDE);
  expect("body records", state.body, 1, shared::BODY_STRIDE);
  expect("gait records", state.gait, 1, shared::GAIT_STRIDE);
  expect("step records", state.step, legs, shared::STEP_STRIDE);
  if (crowd::aimsSteps(setting.controller)) expect("arc records", state.arc, legs, shared::ARC_STRIDE);
  if (!state.foot.empty()) expect("foot records", state.foot, legs, shared::FOOT_STRIDE);
  expect("chain records", state.chain, legs, shared::chainStride(setting.bones));
  if (!state.tip.empty()) expect("tip records", state.tip, legs, shared::TIP_STRIDE);
  if (crowd::tellsMisses(setting.controller))
    expect("miss records", state.miss, 1, shared::missStride(setting.legs));
  const size_t bones = static_cast<size_t>(setting.bones);
  const bool clips = crowd::playsClips(setting.controller);
  if (clips) expect("play records", state.play, 1, shared::PLAY_STRIDE);
  if (clips && !state.pose.empty())
    expect("pose records", state.pose, setting.clips.joints(), shared::MATRIX_STRIDE);
  else if (!state.pose.empty())
    expect("pose records", state.pose, 1 + legs * bones, shared::POSE_STRIDE);
  if (setting.controller == crowd::Controller::planted) {
    expect("start records", state.start, legs, shared::startStride(setting.bones));
    expect("fix records", state.fix, legs * bones, shared::FIX_STRIDE);
  }
  if (setting.controller == crowd::Controller::pose)
    expect("spring records", state.spring, legs, shared::chainStride(setting.bones));
  if (state.metric.empty() || agents == 0) return;
  expect("metric records", state.metric, 1, shared::METRIC_STRIDE);
  const auto floats = static_cast<size_t>(4 * shared::watchStride(setting.legs));
  const size_t last = state.sample.first + (agents - 1) * state.sample.stride;
  if (state.watch.size() % floats != 0 || state.watch.size() / floats <= last / state.watchEvery)
    throw inputError("watch records: found " + std::to_string(state.watch.size()) + " floats, " +
                     std::to_string(floats) + " an agent that is watched, and agent " + std::to_string(last) +
                     " is not among them");
}

// splitmix64: Steele, Lea & Flood 2014.
uint64_t scrambled(uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return x ^ x >> 31;
}

}  // namespace

AgentSample sampleAt(uint64_t seed, uint64_t n, uint32_t agents, uint32_t most) {
  const uint32_t stride = agents / most + 1;
  return {static_cast<uint32_t>(scrambled(seed ^ scrambled(n)) % stride), stride};
}

HerdState sampled(const HerdState& whole, const AgentSample& sample) {
  HerdState part;
  part.tick = whole.tick;
  part.sample = sample;
  part.watched = whole.watched;
  part.sleep = whole.sleep;
  for (size_t agent = sample.first; agent < whole.agents; agent += sample.stride) ++part.agents;
  for (const auto records :
       {&HerdState::goal, &HerdState::steer, &HerdState::body, &HerdState::gait, &HerdState::step,
        &HerdState::arc, &HerdState::foot, &HerdState::chain, &HerdState::tip, &HerdState::miss,
        &HerdState::pose, &HerdState::play, &HerdState::start, &HerdState::fix, &HerdState::spring}) {
    const std::vector<float>& from = whole.*records;
    const size_t each = from.size() / std::max(1u, whole.agents);
    for (size_t agent = sample.first; agent < whole.agents; agent += sample.stride)
      (part.*records)
          .insert((part.*records).end(), from.begin() + static_cast<ptrdiff_t>(agent * each),
                  from.begin() + static_cast<ptrdiff_t>((agent + 1) * each));
  }
  return part;
}

Setting settingOf(const HerdFacts& herd, const Heightfield& terrain) {
  const Rig& rig = herd.rig;
  size_t bones = 0;
  for (const Leg& leg : rig.legs) bones = std::max(bones, leg.bones.size());
  Setting setting;
  setting.controller = herd.controller;
  setting.legs = rig.legCount();
  setting.bones = static_cast<int>(bones);
  expectSize("rig records", herd.rigRecords.size(),
             4 * rig.legs.size() * static_cast<size_t>(shared::rigStride(setting.bones)));
  setting.tuning = tuningOf(herd.parameters);
  setting.heights = heightsOf(terrain, herd.parameters);
  setting.creature = creatureOf(herd.rigRecords, setting.legs, setting.bones, rig.groupCount());
  setting.extent = std::max({std::abs(setting.heights.originX), std::abs(setting.heights.originZ),
                             setting.tuning.halfExtentX, setting.tuning.halfExtentZ});
  // The reference has no `automatic`.
  setting.ik = {static_cast<reference::IkSolver>(herd.ik.solver - shared::SOLVER_FABRIK), herd.ik.approach,
                herd.ik.polish};
  if (crowd::playsClips(herd.controller))
    setting.clips = clipTableOf(herd.clips, setting.legs, setting.bones);
  if (herd.controller == crowd::Controller::pose)
    setting.keyPoses = keyPosesOf(herd.keyPoses, setting.legs, setting.bones);
  return setting;
}

Replay::Replay(const HerdFacts& herd) : terrain_(herd.terrain), setting_(settingOf(herd, terrain_)) {
  for (const Stage& stage : stagesOf(herd.controller)) judges_.emplace_back(stage.name);
}

void Replay::tick(uint64_t n, const HerdState& before, const HerdState& after) {
  if (before.agents != after.agents) {
    throw inputError("replay: found " + std::to_string(after.agents) + " agents after the tick, expected " +
                     std::to_string(before.agents));
  }
  expectSizes(setting_, before);
  expectSizes(setting_, after);
  const auto left = [&](std::string_view stage) {
    return (stage == "pose" && after.pose.empty()) || (stage == "swing" && after.foot.empty()) ||
           (stage == "footfall" && !after.footfallsKept) ||
           (stage == "measure" && (before.metric.empty() || after.metric.empty()));
  };
  const Stages& stages = stagesOf(setting_.controller);
  for (size_t agent = 0; agent < before.agents; ++agent) {
    const Moment moment{n, before, after, agent};
    const bool asleep = asleepOf(after, agent);
    for (size_t s = 0; s < stages.size(); ++s) {
      if (left(stages[s].name)) continue;
      if (!asleep || stages[s].writes.empty()) stages[s].check(setting_, moment, judges_[s]);
      for (const Kept& kept : stages[s].writes)
        if (asleep) checkKept(setting_, moment, kept, judges_[s]);
    }
  }
}

void Replay::edit(uint32_t x0, uint32_t z0, uint32_t columns, uint32_t rows, std::span<const float> heights) {
  for (uint32_t z = 0; z < rows; ++z)
    for (uint32_t x = 0; x < columns; ++x)
      terrain_.heights[size_t{z0 + z} * terrain_.columns + x0 + x] = heights[size_t{z} * columns + x];
}

std::vector<StageResult> Replay::results() const {
  std::vector<StageResult> results;
  for (const Judge& judge : judges_) results.push_back(judge.result());
  return results;
}

bool Replay::pass() const {
  return std::all_of(judges_.begin(), judges_.end(), [](const Judge& judge) { return judge.result().pass; });
}

std::string table(const std::vector<StageResult>& results) {
  std::string text = "stage        samples   max error   tolerance    ties  result\n";
  for (const StageResult& result : results) {
    char line[160];
    std::snprintf(line, sizeof line, "%-10s %9llu  %10.3g  %10.3g  %6llu  %s\n", result.name.c_str(),
                  static_cast<unsigned long long>(result.samples), result.maxError, result.tolerance,
                  static_cast<unsigned long long>(result.ties), result.pass ? "pass" : "FAIL");
    text += line;
    if (!result.pass) text += "           " + result.worst + "\n";
  }
  return text;
}

}  // namespace skitter::validation

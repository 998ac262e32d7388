#include "crowd/page.h"

#include <algorithm>
#include <string>

#include "crowd/stage.h"
#include "gpu/context.h"
#include "gpu/transfer.h"
#include "skitter/error.h"

namespace skitter::crowd {
namespace {

constexpr uint32_t kMostPageAgents = 65536;

}  // namespace

gpu::Binding bindingOf(const Crowd::Impl& crowd, const Herd& herd, const Page& page, uint32_t binding) {
  using namespace shared;
  switch (binding) {
    case BINDING_PARAMETERS:
      return {binding, &herd.parameterBlock};
    case BINDING_HEIGHTS:
      return {binding, &crowd.heights};
    case BINDING_RIG:
      return {binding, &herd.rigBuffer};
    case BINDING_LIST:
      return {binding, &page.list};
    case BINDING_COUNTERS:
      return {binding, &page.counters};
    case BINDING_HISTOGRAM:
      return {binding, &page.histogram};
    case BINDING_GOAL:
    case BINDING_GOAL_OUT:
      return {binding, &page.goal};
    case BINDING_STEER:
    case BINDING_STEER_OUT:
      return {binding, &page.steer};
    case BINDING_BODY:
    case BINDING_BODY_OUT:
      return {binding, &page.body};
    case BINDING_GAIT:
    case BINDING_GAIT_OUT:
      return {binding, &page.gait};
    case BINDING_STEP:
    case BINDING_STEP_OUT:
      return {binding, &page.step};
    case BINDING_FOOT:
    case BINDING_FOOT_OUT:
      return {binding, &page.foot};
    case BINDING_CHAIN:
    case BINDING_CHAIN_OUT:
      return {binding, &page.chain};
    case BINDING_POSE:
    case BINDING_POSE_OUT:
      return {binding, &page.pose};
    case BINDING_PLAY:
    case BINDING_PLAY_OUT:
      return {binding, &page.play};
    case BINDING_START:
    case BINDING_START_OUT:
      return {binding, &page.start};
    case BINDING_FIX:
    case BINDING_FIX_OUT:
      return {binding, &page.fix};
    case BINDING_SPRING:
    case BINDING_SPRING_OUT:
      return {binding, &page.spring};
    case BINDING_KEY:
      return {binding, &herd.keyBuffer};
    case BINDING_CLIP:
      return {binding, &herd.clipHeads};
    case BINDING_CLIP_FRAME:
      return {binding, &herd.clipTimes};
    case BINDING_CLIP_ROW:
      return {binding, &herd.clipRows};
    case BINDING_CLIP_LEG:
      return {binding, &herd.clipLegs};
    case BINDING_CLIP_JOINT:
      return {binding, &herd.clipBones};
    case BINDING_WATCH:
    case BINDING_WATCH_OUT:
      return {binding, &page.watch};
    case BINDING_FLIGHT:
    case BINDING_FLIGHT_OUT:
      return {binding, &page.flight};
    case BINDING_FOOTFALL_OUT:
      return {binding, &page.footfall};
    default:
      return {binding, &page.metric};
  }
}

RecordBytes recordBytes(const Herd& herd) {
  using namespace shared;
  const Rig& rig = herd.rig;
  const bool clips = playsClips(herd.controller), planted = herd.controller == Controller::planted;
  const auto legs = static_cast<uint64_t>(rig.legCount());
  const auto vec4s = [](uint64_t count, int stride) { return count * static_cast<uint64_t>(stride) * 16; };
  return {.goal = vec4s(1, GOAL_STRIDE),
          .steer = vec4s(1, STEER_STRIDE),
          .body = vec4s(1, BODY_STRIDE),
          .gait = vec4s(1, GAIT_STRIDE),
          .step = vec4s(legs, STEP_STRIDE),
          .foot = vec4s(legs, FOOT_STRIDE),
          .chain = vec4s(legs, chainStride(rig.maxBones())),
          .pose = clips ? vec4s(static_cast<uint64_t>(herd.clips.joints), MATRIX_STRIDE)
                        : vec4s(static_cast<uint64_t>(rig.paletteSize()), POSE_STRIDE),
          .metric = vec4s(1, METRIC_STRIDE),
          .list = legs * 4,
          .watch = vec4s(1, watchStride(rig.legCount())),
          .play = clips ? vec4s(1, PLAY_STRIDE) : 0,
          .start = planted ? vec4s(legs, chainStride(rig.maxBones())) : 0,
          .fix = planted ? vec4s(legs * static_cast<uint64_t>(rig.maxBones()), FIX_STRIDE) : 0,
          .spring = herd.controller == Controller::pose ? vec4s(legs, chainDirections(rig.maxBones())) : 0};
}

uint32_t agentsPerPage(const gpu::Context& context, const CrowdOptions& options, const RecordBytes& bytes) {
  uint64_t limit = context.limits().maxStorageBufferRange;
  if (context.texelLoads()) limit = std::min(limit, context.limits().maxTexelBufferElements * 16);
  uint64_t agents = std::min<uint64_t>(kMostPageAgents, limit / bytes.largest());
  if (options.pageAgents > 0) agents = std::min<uint64_t>(agents, options.pageAgents);
  if (agents == 0)
    throw deviceError(context.report().name + ": a binding reaches " + std::to_string(limit) +
                      " bytes, one agent needs " + std::to_string(bytes.largest()));
  return static_cast<uint32_t>(agents);
}

Page makePage(const Crowd::Impl& crowd, const Herd& herd, const Spawner& spawner, uint32_t first,
              uint32_t agents) {
  const gpu::Context& context = *crowd.context;
  const RecordBytes bytes = recordBytes(herd);
  HerdState spawned;
  spawner.append(first, agents, spawned);
  Page page;
  page.firstAgent = first;
  page.agents = agents;
  const auto make = [&](gpu::Buffer& buffer, uint64_t each, const char* name) {
    buffer = gpu::Buffer(context, each * agents, name);
  };
  make(page.goal, bytes.goal, "goal");
  make(page.steer, bytes.steer, "steer");
  make(page.body, bytes.body, "body");
  make(page.gait, bytes.gait, "gait");
  make(page.step, bytes.step, "step");
  make(page.foot, bytes.foot, "foot");
  make(page.chain, bytes.chain, "chain");
  make(page.pose, bytes.pose, "pose");
  make(page.metric, bytes.metric, "metric");
  make(page.list, bytes.list, "list");
  if (bytes.play > 0) make(page.play, bytes.play, "play");
  if (bytes.start > 0) make(page.start, bytes.start, "start");
  if (bytes.fix > 0) make(page.fix, bytes.fix, "fix");
  if (bytes.spring > 0) make(page.spring, bytes.spring, "spring");
  const uint64_t watched = (uint64_t{agents} + crowd.watchEvery - 1) / crowd.watchEvery;
  page.watch = gpu::Buffer(context, bytes.watch * watched, "watch");
  const auto legs = static_cast<uint64_t>(herd.legs) * agents;
  page.footfallRoom = static_cast<uint32_t>(std::min<uint64_t>(crowd.options.footfalls, legs));
  page.flight = gpu::Buffer(context, page.footfallRoom > 0 ? legs * shared::FLIGHT_STRIDE * 16 : 0, "flight");
  page.footfall =
      gpu::Buffer(context, uint64_t{page.footfallRoom} * shared::FOOTFALL_STRIDE * 16, "footfall");
  page.counters = gpu::Buffer(context, shared::COUNTERS * 4, "counters", gpu::BufferUse::indirect);
  page.histogram = gpu::Buffer(context, shared::HISTOGRAM_BUCKETS * 4, "histogram");
  gpu::upload(context, page.goal, spawned.goal);
  gpu::upload(context, page.steer, spawned.steer);
  gpu::upload(context, page.body, spawned.body);
  gpu::upload(context, page.gait, spawned.gait);
  gpu::upload(context, page.step, spawned.step);
  gpu::upload(context, page.foot, spawned.foot);
  gpu::upload(context, page.chain, spawned.chain);
  if (bytes.play > 0) gpu::upload(context, page.play, spawned.play);
  if (bytes.start > 0) gpu::clear(context, page.start);
  if (bytes.fix > 0) gpu::clear(context, page.fix);
  if (bytes.spring > 0) gpu::clear(context, page.spring);
  gpu::clear(context, page.pose);
  gpu::clear(context, page.metric);
  gpu::clear(context, page.watch);
  gpu::clear(context, page.flight);
  gpu::clear(context, page.counters);
  gpu::clear(context, page.histogram);
  const std::vector<Stage>& stages = stagesOf(herd.controller);
  for (size_t i = 0; i < stages.size(); ++i) {
    std::vector<gpu::Binding> list;
    for (const gpu::BindingDecl& declared : stages[i].bindings)
      list.push_back(bindingOf(crowd, herd, page, declared.binding));
    page.bindings.push_back(herd.kernels[i].bind(context, list));
  }
  return page;
}

}  // namespace skitter::crowd

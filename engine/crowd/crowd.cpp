#include "skitter/crowd.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>

#include "crowd/herd.h"
#include "crowd/rig_records.h"
#include "crowd/spawn.h"
#include "crowd/stage.h"
#include "crowd/tuning.h"
#include "gpu/barrier.h"
#include "gpu/context.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "skitter/error.h"

namespace skitter {
namespace {

using crowd::Page;
using crowd::Stage;
using Impl = Crowd::Impl;

// The frame: what is recorded, in this order.
const std::vector<Stage>& stages() {
  static const std::vector<Stage> list = {
      crowd::navigateStage(), crowd::bodyStage(), crowd::gaitStage(), crowd::footholdStage(),
      crowd::swingStage(),    crowd::ikStage(),   crowd::poseStage(), crowd::measureStage(),
  };
  return list;
}
constexpr size_t kFoothold = 3, kSwing = 4, kIk = 5, kPose = 6, kMeasure = 7;

// The chains start at rest and must reach their feet before the first tick.
constexpr int kSettleIterations = 24;
constexpr uint32_t kMostPageAgents = 65536;
// World coordinates beyond it are too coarse in float32 for a foot to be placed.
constexpr float kFarthest = 4096;

// Bytes an agent in each of the page's record buffers.
struct RecordBytes {
  uint64_t goal, steer, body, gait, step, foot, chain, pose, metric, list;
  uint64_t largest() const { return std::max({body, step, foot, chain, pose, metric, list}); }
  uint64_t sum() const { return goal + steer + body + gait + step + foot + chain + pose + metric + list; }
};

RecordBytes recordBytes(const Rig& rig) {
  using namespace shared;
  const auto legs = static_cast<uint64_t>(rig.legCount());
  const auto vec4s = [](uint64_t count, int stride) { return count * static_cast<uint64_t>(stride) * 16; };
  return {.goal = vec4s(1, GOAL_STRIDE),
          .steer = vec4s(1, STEER_STRIDE),
          .body = vec4s(1, BODY_STRIDE),
          .gait = vec4s(1, GAIT_STRIDE),
          .step = vec4s(legs, STEP_STRIDE),
          .foot = vec4s(legs, FOOT_STRIDE),
          .chain = vec4s(legs, chainStride(rig.maxBones())),
          .pose = vec4s(static_cast<uint64_t>(rig.paletteSize()), POSE_STRIDE),
          .metric = vec4s(legs, METRIC_STRIDE),
          .list = legs * 4};
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

std::vector<Rig> loadRigs(const Scene& scene) {
  std::vector<Rig> rigs;
  for (const Herd& herd : scene.herds) rigs.push_back(herd.rig == "spider" ? spiderRig() : loadRig(herd.rig));
  return rigs;
}

gpu::Binding bindingOf(const Impl& crowd, const crowd::Herd& herd, const Page& page, uint32_t binding) {
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
    default:
      return {binding, &page.metric};
  }
}

Page makePage(const Impl& crowd, const crowd::Herd& herd, const crowd::Spawner& spawner, uint32_t first,
              uint32_t agents) {
  const gpu::Context& context = *crowd.context;
  const RecordBytes bytes = recordBytes(herd.rig);
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
  page.counters = gpu::Buffer(context, shared::COUNTERS * 4, "counters", gpu::BufferUse::indirect);
  page.histogram = gpu::Buffer(context, shared::HISTOGRAM_BUCKETS * 4, "histogram");
  gpu::upload(context, page.goal, spawned.goal);
  gpu::upload(context, page.steer, spawned.steer);
  gpu::upload(context, page.body, spawned.body);
  gpu::upload(context, page.gait, spawned.gait);
  gpu::upload(context, page.step, spawned.step);
  gpu::upload(context, page.foot, spawned.foot);
  gpu::upload(context, page.chain, spawned.chain);
  gpu::upload(context, page.metric, spawned.metric);
  gpu::clear(context, page.pose);
  gpu::clear(context, page.counters);
  gpu::clear(context, page.histogram);
  for (size_t i = 0; i < stages().size(); ++i) {
    std::vector<gpu::Binding> list;
    for (const gpu::BindingDecl& declared : stages()[i].bindings)
      list.push_back(bindingOf(crowd, herd, page, declared.binding));
    page.bindings.push_back(herd.kernels[i].bind(context, list));
  }
  return page;
}

void makeKernels(const gpu::Context& context, const CrowdOptions& options, crowd::Herd& herd) {
  using namespace shared;
  for (const Stage& stage : stages()) {
    gpu::KernelInfo info{stage.name, stage.code, stage.bindings, sizeof(TickConstants)};
    for (const StageShader& other : options.shaders)
      if (other.stage == stage.name) info.code = {other.texel, other.storage};
    info.constants = {
        {CONSTANT_LEGS, herd.legs}, {CONSTANT_BONES, herd.bones}, {CONSTANT_GROUPS, herd.groups}};
    if (std::strcmp(stage.name, "ik") == 0) {
      info.constants.emplace_back(CONSTANT_FABRIK_ITERATIONS, crowd::kFabrikIterations);
      info.constants.emplace_back(CONSTANT_POLISH_ITERATIONS, crowd::kPolishIterations);
    }
    herd.kernels.emplace_back(context, info);
  }
}

void dispatch(const crowd::Herd& herd, const Page& page, size_t index, float tick, vk::CommandBuffer cmd) {
  const Stage& stage = stages()[index];
  const uint32_t count =
      stage.over == Stage::Over::agents ? page.agents : page.agents * static_cast<uint32_t>(herd.legs);
  const shared::TickConstants constants{count, tick};
  const auto push = gpu::bytesOf(constants);
  if (stage.over == Stage::Over::listed)
    herd.kernels[index].dispatchIndirect(cmd, page.bindings[index], push, page.counters);
  else
    herd.kernels[index].dispatch(cmd, page.bindings[index], push, gpu::groupsFor(count, shared::WORK_GROUP));
}

// Zero listed legs; the counts since the start stay.
void clearLists(const Impl& crowd, vk::CommandBuffer cmd) {
  constexpr std::array<uint32_t, 4> none = {0, 1, 1, 0};
  for (const crowd::Herd& herd : crowd.herds)
    for (const Page& page : herd.pages) cmd.updateBuffer(page.counters.handle(), 0, sizeof none, none.data());
}

void recordStage(Impl& crowd, size_t index, float tick, vk::CommandBuffer cmd) {
  for (const crowd::Herd& herd : crowd.herds)
    for (const Page& page : herd.pages) dispatch(herd, page, index, tick, cmd);
}

// Every pipeline runs once with nothing to do, so that no tick pays for its translation to machine code, and
// the chains are brought to their feet.
void settle(Impl& crowd) {
  gpu::submitAndWait(*crowd.context, [&](vk::CommandBuffer cmd) {
    clearLists(crowd, cmd);
    gpu::transferToCompute(cmd);
    const shared::TickConstants nothing{0, 0};
    for (size_t i = 0; i < stages().size(); ++i) {
      for (const crowd::Herd& herd : crowd.herds)
        for (const Page& page : herd.pages)
          herd.kernels[i].dispatch(cmd, page.bindings[i], gpu::bytesOf(nothing), 1);
      gpu::computeToCompute(cmd);
    }
    recordStage(crowd, kSwing, 0, cmd);
    for (int i = 0; i < kSettleIterations; ++i) {
      gpu::computeToCompute(cmd);
      recordStage(crowd, kIk, 0, cmd);
    }
    gpu::computeToCompute(cmd);
    recordStage(crowd, kPose, 0, cmd);
  });
}

void setTick(Impl& crowd, float dt) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw inputError("dt " + std::to_string(dt) + ": expected a finite time above 0");
  if (crowd.dt == dt) return;
  if (crowd.dt != 0)
    throw inputError("dt changed from " + std::to_string(crowd.dt) + " to " + std::to_string(dt) +
                     ": steps are timed in ticks, so a crowd keeps its first dt");
  crowd.dt = dt;
  for (crowd::Herd& herd : crowd.herds) {
    herd.parameters = crowd::tuningFor(herd.rig, crowd.terrain, dt);
    std::memcpy(herd.parameterBlock.bytes().data(), &herd.parameters, sizeof herd.parameters);
  }
}

template <class T>
void appendRecords(const gpu::Context& context, const gpu::Buffer& buffer, std::vector<T>& records) {
  const std::vector<T> page = gpu::download<T>(context, buffer);
  records.insert(records.end(), page.begin(), page.end());
}

}  // namespace

Crowd::Crowd(Device& device, const Heightfield& terrain, const Scene& scene, const CrowdOptions& options)
    : Crowd(device, terrain, scene, loadRigs(scene), options) {}

Crowd::Crowd(Device& device, const Heightfield& terrain, const Scene& scene, std::vector<Rig> rigs,
             const CrowdOptions& options)
    : impl_(std::make_unique<Impl>()) {
  assert(rigs.size() == scene.herds.size());
  Impl& crowd = *impl_;
  const gpu::Context& context = device.context();
  crowd.context = &context;
  crowd.options = options;
  if (std::max(terrain.extentX(), terrain.extentZ()) > 2 * kFarthest)
    throw inputError(terrain.name + ": the terrain is " +
                     std::to_string(static_cast<int>(terrain.extentX())) + " x " +
                     std::to_string(static_cast<int>(terrain.extentZ())) +
                     " m, expected at most 8192 m a side; --scale or the scene's scale makes it smaller");
  crowd.terrain = terrain;
  crowd.heights = gpu::Image(
      context, {vk::Format::eR32Sfloat, {terrain.columns, terrain.rows}, vk::ImageUsageFlagBits::eSampled},
      "heights");
  gpu::uploadImage(context, crowd.heights, terrain.heights);
  if (options.timestamps) crowd.timer = gpu::StageTimer(context, static_cast<uint32_t>(stages().size()));

  for (const Herd& from : scene.herds) {
    crowd::Herd& herd = crowd.herds.emplace_back();
    if (from.controller != "adaptive")
      throw inputError("controller '" + from.controller + "' is unknown; there is: adaptive");
    herd.rig = std::move(rigs[crowd.herds.size() - 1]);
    herd.legs = herd.rig.legCount();
    herd.bones = herd.rig.maxBones();
    herd.groups = herd.rig.groupCount();
    herd.parameters = crowd::tuningFor(herd.rig, terrain, 1.0f / 60);
    herd.parameterBlock =
        gpu::HostBuffer(context, sizeof herd.parameters, gpu::HostUse::upload, "parameters");
    std::memcpy(herd.parameterBlock.bytes().data(), &herd.parameters, sizeof herd.parameters);
    herd.rigRecords = crowd::rigRecords(herd.rig);
    herd.rigBuffer = gpu::Buffer(context, herd.rigRecords.size() * sizeof(float), "rig");
    gpu::upload(context, herd.rigBuffer, herd.rigRecords);
    makeKernels(context, options, herd);

    const RecordBytes bytes = recordBytes(herd.rig);
    const uint64_t needed = bytes.sum() * from.agents;
    if (needed > context.limits().availableBytes)
      throw deviceError(std::to_string(from.agents) + " agents need " + std::to_string(needed >> 20) +
                        " MiB, " + context.report().name + " has " +
                        std::to_string(context.limits().availableBytes >> 20) + " MiB");
    const uint64_t herdIndex = crowd.herds.size() - 1;
    const crowd::Spawner spawner(from, herd.rig, terrain, herd.parameters, scene.seed + (herdIndex << 32));
    const uint32_t most = agentsPerPage(context, options, bytes);
    for (uint32_t first = 0; first < from.agents; first += most)
      herd.pages.push_back(makePage(crowd, herd, spawner, first, std::min(most, from.agents - first)));
  }
  settle(crowd);
}

Crowd::~Crowd() = default;
Crowd::Crowd(Crowd&&) noexcept = default;
Crowd& Crowd::operator=(Crowd&&) noexcept = default;

void Crowd::record(VkCommandBuffer commandBuffer, float dt) {
  Impl& crowd = *impl_;
  const vk::CommandBuffer cmd(commandBuffer);
  setTick(crowd, dt);
  const auto tick = static_cast<float>(++crowd.tick);

  crowd.timer.reset(cmd);
  gpu::graphicsToCompute(cmd);
  gpu::computeToTransfer(cmd);
  clearLists(crowd, cmd);
  gpu::transferToCompute(cmd);
  for (size_t i = 0; i < stages().size(); ++i) {
    if ((i == kPose && !crowd.options.pose) || (i == kMeasure && !crowd.options.measure)) continue;
    crowd.timer.begin(cmd, stages()[i].name);
    recordStage(crowd, i, tick, cmd);
    crowd.timer.end(cmd, stages()[i].name);
    if (i + 1 == kFoothold)
      gpu::computeToIndirectAndCompute(cmd);
    else
      gpu::computeToCompute(cmd);
  }
  gpu::computeToGraphics(cmd);
  gpu::computeToTransfer(cmd);
}

uint64_t Crowd::tick() const { return impl_->tick; }
uint32_t Crowd::herdCount() const { return static_cast<uint32_t>(impl_->herds.size()); }
const Rig& Crowd::rig(uint32_t herd) const { return impl_->herds.at(herd).rig; }

uint64_t Crowd::agentCount() const {
  uint64_t count = 0;
  for (const crowd::Herd& herd : impl_->herds)
    for (const Page& page : herd.pages) count += page.agents;
  return count;
}

uint64_t Crowd::memoryBytes() const {
  uint64_t bytes = 0;
  for (const crowd::Herd& herd : impl_->herds)
    for (const Page& page : herd.pages) bytes += recordBytes(herd.rig).sum() * page.agents;
  return bytes;
}

HerdState Crowd::download(uint32_t herdIndex) const {
  const gpu::Context& context = *impl_->context;
  context.waitIdle();
  HerdState state;
  for (const Page& page : impl_->herds.at(herdIndex).pages) {
    state.agents += page.agents;
    appendRecords(context, page.goal, state.goal);
    appendRecords(context, page.steer, state.steer);
    appendRecords(context, page.body, state.body);
    appendRecords(context, page.gait, state.gait);
    appendRecords(context, page.step, state.step);
    appendRecords(context, page.foot, state.foot);
    appendRecords(context, page.chain, state.chain);
    appendRecords(context, page.pose, state.pose);
    appendRecords(context, page.metric, state.metric);
  }
  return state;
}

Fidelity Crowd::fidelity() const {
  const gpu::Context& context = *impl_->context;
  context.waitIdle();
  Fidelity f;
  double slip = 0, stances = 0, penetration = 0, floating = 0, ticks = 0, planted = 0;
  std::vector<uint64_t> buckets(shared::HISTOGRAM_BUCKETS);
  for (const crowd::Herd& herd : impl_->herds) {
    const double length = herd.rig.legLength;
    for (const Page& page : herd.pages) {
      const std::vector<float> m = gpu::download<float>(context, page.metric);
      for (size_t i = 0; i + 11 < m.size(); i += shared::METRIC_STRIDE * 4) {
        slip += m[i + 4] / length;
        stances += m[i + 5];
        penetration += m[i + 6] / length;
        floating += m[i + 7] / length;
        ticks += m[i + 8];
        planted += m[i + 9];
        f.limitViolation = std::max(f.limitViolation, double{m[i + 11]});
      }
      const std::vector<uint32_t> counts = gpu::download<uint32_t>(context, page.histogram);
      for (size_t i = 0; i < buckets.size(); ++i) buckets[i] += counts[i];
      const std::vector<uint32_t> counters = gpu::download<uint32_t>(context, page.counters);
      f.lastResorts += counters[shared::COUNTER_LAST_RESORTS];
      f.notFinite += counters[shared::COUNTER_NOT_FINITE];
    }
  }
  if (stances > 0) f.slip = slip / stances;
  if (ticks > 0) f.penetration = penetration / ticks;
  if (planted > 0) f.floating = floating / planted;
  uint64_t all = 0, seen = 0;
  for (const uint64_t count : buckets) all += count;
  for (size_t i = 0; i < buckets.size() && all > 0; ++i) {
    seen += buckets[i];
    if (static_cast<double>(seen) < 0.99 * static_cast<double>(all)) continue;
    f.reachErrorP99 = std::exp2(static_cast<double>(i + 1) / 4 - 20);  // the bucket's upper edge
    break;
  }
  return f;
}

uint64_t Crowd::stateHash() const {
  const gpu::Context& context = *impl_->context;
  context.waitIdle();
  uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a, a word at a time
  for (const crowd::Herd& herd : impl_->herds) {
    // Record by record over the herd, not page by page: how agents are paged must not show.
    for (const auto buffer : {&Page::goal, &Page::body, &Page::gait, &Page::step, &Page::chain})
      for (const Page& page : herd.pages)
        for (const uint32_t word : gpu::download<uint32_t>(context, page.*buffer)) {
          hash = (hash ^ word) * 0x100000001b3ull;
          hash ^= hash >> 32;
        }
  }
  return hash;
}

std::vector<StageTime> Crowd::stageTimes() const {
  std::vector<StageTime> times;
  if (!impl_->timer.measures()) return times;
  impl_->context->waitIdle();
  for (const gpu::StageTime& t : impl_->timer.milliseconds()) times.push_back({t.stage, t.milliseconds});
  return times;
}

}  // namespace skitter

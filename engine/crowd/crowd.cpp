#include "skitter/crowd.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include "crowd/herd.h"
#include "crowd/page.h"
#include "crowd/rig_records.h"
#include "crowd/spawn.h"
#include "crowd/stage.h"
#include "crowd/tuning.h"
#include "crowd/watch.h"
#include "gpu/barrier.h"
#include "gpu/choice.h"
#include "gpu/context.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "skitter/error.h"

namespace skitter {
namespace {

using crowd::Page;
using crowd::Stage;
using Impl = Crowd::Impl;

// The chains start at rest and must reach their feet before the first tick.
constexpr int kSettleIterations = 6;
// World coordinates beyond it are too coarse in float32 for a foot to be placed.
constexpr float kFarthest = 4096;
// Legs, so that nobody goes half of STEP_TILES tiles while a foot stands.
constexpr float kLongest = 100;
// Above it an agent's index is no exact float, as records have it.
constexpr uint64_t kMostAgents = 1 << 24;

std::string gibibytes(uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f GiB", static_cast<double>(bytes) / (1 << 30));
  return text;
}

std::vector<Rig> loadRigs(const Scene& scene) {
  std::vector<Rig> rigs;
  for (const Herd& herd : scene.herds) {
    const bool clips = crowd::needsClips(crowd::controllerNamed(herd.controller));
    rigs.push_back(herd.rig == "spider" ? spiderRig() : clips ? proposedRig(herd.rig) : loadRig(herd.rig));
  }
  return rigs;
}

void loadClips(const gpu::Context& context, const Herd& from, crowd::Herd& herd) {
  ClipSet set = from.rig == "spider" ? spiderClips() : skitter::loadClips(from.rig, herd.rig, from.cuts);
  std::vector<std::string> names = from.clips;
  if (names.empty())
    for (const ClipCut& cut : from.cuts) names.push_back(cut.name);
  const auto upload = [&](gpu::Buffer& buffer, const std::vector<float>& records, const char* name) {
    buffer = gpu::Buffer(context, records.size() * sizeof(float), name);
    gpu::upload(context, buffer, records);
  };
  if (herd.controller == crowd::Controller::pose) {
    herd.keyPoses = crowd::keyPoses(set, names, from.keys, herd.rig, herd.rigRecords);
    upload(herd.keyBuffer, herd.keyPoses.records, "key poses");
    return;
  }
  herd.clipSet = std::move(set);
  herd.clips = crowd::clipRecords(herd.clipSet, names, herd.bones);
  for (Clip& clip : herd.clipSet.clips) clip.rows = {};
  upload(herd.clipHeads, herd.clips.heads, "clips");
  upload(herd.clipTimes, herd.clips.times, "clip frames");
  upload(herd.clipRows, herd.clips.rows, "clip rows");
  upload(herd.clipLegs, herd.clips.legs, "clip legs");
  upload(herd.clipBones, herd.clips.bones, "clip joints");
}

uint32_t invocations(const crowd::Herd& herd, const Page& page, Stage::Over over) {
  const uint32_t agents = crowd::wholeBlocks(page.agents);
  switch (over) {
    case Stage::Over::joints:
      return page.agents * static_cast<uint32_t>(herd.clips.joints);
    case Stage::Over::legs:
    case Stage::Over::everyLeg:
      return agents * static_cast<uint32_t>(herd.legs);
    case Stage::Over::blocks:
      return agents / shared::BLOCK;
    case Stage::Over::everyone:
    case Stage::Over::agents:
    case Stage::Over::listed:
    case Stage::Over::watched:
      break;
  }
  return page.agents;
}

// Where the counters have the dispatch over those who are awake.
uint64_t awakeArguments(Stage::Over over) {
  return sizeof(uint32_t) * (over == Stage::Over::agents ? shared::COUNTER_AWAKE_AGENTS_X
                             : over == Stage::Over::legs ? shared::COUNTER_AWAKE_LEGS_X
                                                         : shared::COUNTER_AWAKE_JOINTS_X);
}

bool isNamed(const Stage& stage, std::string_view name) { return stage.name == name; }

// In the ticks after an edit of the heights gait looks at the ground under every foot, and nobody sleeps.
bool watchesGround(const Impl& crowd) { return crowd.watchUntil > 0 && crowd.tick <= crowd.watchUntil; }

const gpu::Kernel& kernelOf(const Impl& crowd, const crowd::Herd& herd, size_t index) {
  return herd.watchingGait && watchesGround(crowd) && crowd::makes(herd.stages[index].name, "gait")
             ? herd.watchingGait
             : herd.kernels[index];
}

shared::TickConstants constantsOf(const Impl& crowd, const crowd::Herd& herd, const Page& page,
                                  Stage::Over over, uint64_t tick) {
  if (over == Stage::Over::watched) {
    const crowd::Watch watch = crowd::watchAt(tick, crowd.watchEvery, page);
    return {watch.count, static_cast<float>(tick), watch.first, crowd.watchEvery, watch.watched, 0, 0};
  }
  return {page.agents,
          static_cast<float>(tick),
          page.firstAgent,
          1,
          0,
          page.footfallRoom,
          watchesGround(crowd) ? std::numeric_limits<float>::infinity() : herd.parameters.sleepTime};
}

void dispatch(const Impl& crowd, const crowd::Herd& herd, const Page& page, size_t index, uint64_t tick,
              vk::CommandBuffer cmd) {
  const Stage& stage = herd.stages[index];
  const shared::TickConstants constants = constantsOf(crowd, herd, page, stage.over, tick);
  const auto push = gpu::bytesOf(constants);
  if (stage.over == Stage::Over::listed)
    herd.kernels[index].dispatchIndirect(cmd, page.bindings[index], push, page.counters);
  else if (crowd.options.sleep && crowd::isOfTheAwake(stage))
    kernelOf(crowd, herd, index)
        .dispatchIndirect(cmd, page.bindings[index], push, page.counters, awakeArguments(stage.over));
  else
    kernelOf(crowd, herd, index)
        .dispatch(cmd, page.bindings[index], push,
                  gpu::groupsFor(invocations(herd, page, stage.over), shared::WORK_GROUP));
}

// Zero listed legs and footfalls; the counts since the start stay.
void clearLists(const Impl& crowd, vk::CommandBuffer cmd) {
  constexpr std::array<uint32_t, shared::COUNTER_LAST_RESORTS> none = {0, 1, 1, 0, 0, 0, 1, 1, 0};
  for (const crowd::Herd& herd : crowd.herds)
    for (const Page& page : herd.pages) cmd.updateBuffer(page.counters.handle(), 0, sizeof none, none.data());
}

// Nobody is awake until `wake` says so.
void clearAwake(const Impl& crowd, vk::CommandBuffer cmd) {
  if (!crowd.options.sleep) return;
  constexpr std::array<uint32_t, shared::COUNTERS - shared::COUNTER_AWAKE_AGENTS_X> none = {0, 1, 1, 0, 1, 1,
                                                                                            0, 1, 1, 0, 0};
  for (const crowd::Herd& herd : crowd.herds)
    for (const Page& page : herd.pages) {
      cmd.updateBuffer(page.counters.handle(), shared::COUNTER_AWAKE_AGENTS_X * sizeof(uint32_t), sizeof none,
                       none.data());
      cmd.fillBuffer(page.awake.handle(), 0, VK_WHOLE_SIZE, 0);
    }
}

bool hasStage(const Impl& crowd, std::string_view name) {
  return std::any_of(crowd.herds.begin(), crowd.herds.end(), [&](const crowd::Herd& herd) {
    return std::any_of(herd.stages.begin(), herd.stages.end(),
                       [&](const Stage& stage) { return isNamed(stage, name); });
  });
}

// Of every herd that has it.
void recordStage(const Impl& crowd, std::string_view name, uint64_t tick, vk::CommandBuffer cmd) {
  const auto eachPage = [&](const auto& record) {
    for (const crowd::Herd& herd : crowd.herds)
      for (size_t i = 0; i < herd.stages.size(); ++i)
        if (isNamed(herd.stages[i], name))
          for (const Page& page : herd.pages) record(herd, page, i);
  };
  eachPage([&](const crowd::Herd& herd, const Page& page, size_t index) {
    dispatch(crowd, herd, page, index, tick, cmd);
  });
  // What the first dispatches left out.
  bool listed = false;
  eachPage([&](const crowd::Herd& herd, const Page& page, size_t index) {
    if (!herd.restKernels[index]) return;
    if (!std::exchange(listed, true)) gpu::computeToIndirectAndCompute(cmd);
    const Stage& stage = herd.stages[index];
    const shared::TickConstants constants = constantsOf(crowd, herd, page, stage.over, tick);
    const auto at = static_cast<uint64_t>(stage.rest);
    herd.restKernels[index].dispatchIndirect(cmd, page.bindings[index], gpu::bytesOf(constants),
                                             page.counters, at * sizeof(uint32_t));
  });
}

// Every pipeline runs once with nothing to do, so that no tick pays for its translation to machine code, and
// the chains are brought to their feet.
void settle(Impl& crowd) {
  gpu::submitAndWait(*crowd.context, [&](vk::CommandBuffer cmd) {
    clearLists(crowd, cmd);
    clearAwake(crowd, cmd);
    gpu::transferToCompute(cmd);
    const shared::TickConstants nothing{};
    const auto warmUp = [&](const gpu::Kernel& kernel, const crowd::Herd& herd, size_t index) {
      for (const Page& page : herd.pages)
        kernel.dispatch(cmd, page.bindings[index], gpu::bytesOf(nothing), 1);
      gpu::computeToCompute(cmd);
    };
    for (const crowd::Herd& herd : crowd.herds)
      for (size_t i = 0; i < herd.kernels.size(); ++i) {
        warmUp(herd.kernels[i], herd, i);
        if (herd.watchingGait && crowd::makes(herd.stages[i].name, "gait"))
          warmUp(herd.watchingGait, herd, i);
        if (herd.restKernels[i]) warmUp(herd.restKernels[i], herd, i);
      }
    recordStage(crowd, "wake", 0, cmd);
    gpu::computeToIndirectAndCompute(cmd);
    recordStage(crowd, "swing", 0, cmd);
    for (int i = 0; i < kSettleIterations; ++i) {
      gpu::computeToCompute(cmd);
      gpu::computeToTransfer(cmd);
      clearLists(crowd, cmd);  // ik lists legs each time
      gpu::transferToCompute(cmd);
      for (const char* solves : {"ik", "swing+ik"}) recordStage(crowd, solves, 0, cmd);
    }
    gpu::computeToCompute(cmd);
    recordStage(crowd, "pose", 0, cmd);
    recordStage(crowd, "footfall", 0, cmd);  // remembers which feet are in the air
  });
}

shared::Parameters parametersOf(const Impl& crowd, const crowd::Herd& herd, float dt) {
  shared::Parameters parameters = crowd::tuningFor(herd.rig, herd.ik, crowd.terrain, dt);
  parameters.poseKeys = static_cast<float>(herd.keyPoses.keys);
  parameters.poseStride = herd.keyPoses.stride;
  parameters.reachTriggered = parameters.nearestOnly = herd.reachTriggered ? 1.0f : 0.0f;
  return parameters;
}

void setParameters(const Impl& crowd, float dt, crowd::Herd& herd) {
  herd.parameters = parametersOf(crowd, herd, dt);
  std::memcpy(herd.parameterBlock.bytes().data(), &herd.parameters, sizeof herd.parameters);
}

void setTick(Impl& crowd, float dt) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw inputError("dt " + std::to_string(dt) + ": expected a finite time above 0");
  if (crowd.dt == dt) return;
  if (crowd.dt != 0)
    throw inputError("dt changed from " + std::to_string(crowd.dt) + " to " + std::to_string(dt) +
                     ": steps are timed in ticks, so a crowd keeps its first dt");
  for (const crowd::Herd& herd : crowd.herds) {
    const float ticks = herd.parameters.swingStill / dt;
    if (crowd::aimsSteps(herd.controller) && !(ticks < shared::MOST_STEP_TICKS))
      throw inputError(
          fmt::format("dt {:.3g} s: a step of {} would last {:.0f} ticks, expected fewer than {:.0f}", dt,
                      herd.rig.name, ticks, shared::MOST_STEP_TICKS));
  }
  crowd.dt = dt;
  for (crowd::Herd& herd : crowd.herds) setParameters(crowd, dt, herd);
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
  crowd.edits = crowd::HeightEdits(context);
  if (options.timestamps)
    crowd.timer = gpu::StageTimer(context, static_cast<uint32_t>(crowd::frame().size()));

  uint64_t agents = 0;
  for (const Herd& from : scene.herds) agents += from.agents;
  crowd.watchEvery = crowd::watchEvery(options, agents);

  uint64_t needed = 0;
  for (const Herd& from : scene.herds) {
    crowd::Herd& herd = crowd.herds.emplace_back();
    herd.controller = crowd::controllerNamed(from.controller);
    herd.rig = std::move(rigs[crowd.herds.size() - 1]);
    herd.legs = herd.rig.legCount();
    herd.bones = herd.rig.maxBones();
    herd.groups = herd.rig.groupCount();
    if (herd.legs > shared::MOST_LEGS)
      throw inputError(herd.rig.name + ": " + std::to_string(herd.legs) + " legs, expected at most " +
                       std::to_string(shared::MOST_LEGS));
    if (crowd::aimsSteps(herd.controller) && herd.rig.legLength > kLongest)
      throw inputError(fmt::format("{}: legs of {:.4g} m, expected at most {:.4g} m: scale the rig down",
                                   herd.rig.name, herd.rig.legLength, kLongest));
    herd.ik = crowd::ikPlanFor(from.solver);
    if (herd.controller == crowd::Controller::planted && from.solver != "active-set")
      throw inputError("solver '" + from.solver + "': controller planted has active-set alone");
    if (from.stepping != "gait" && from.stepping != "reach")
      throw inputError("stepping '" + from.stepping + "' is unknown; there are: gait, reach");
    herd.reachTriggered = from.stepping == "reach";
    herd.rigRecords = crowd::rigRecords(herd.rig);
    herd.rigBuffer = gpu::Buffer(context, herd.rigRecords.size() * sizeof(float), "rig");
    gpu::upload(context, herd.rigBuffer, herd.rigRecords);
    if (crowd::needsClips(herd.controller)) loadClips(context, from, herd);
    herd.parameterBlock =
        gpu::HostBuffer(context, sizeof(shared::Parameters), gpu::HostUse::upload, "parameters");
    setParameters(crowd, 1.0f / 60, herd);
    herd.stages = crowd::stagesOf(herd.controller, options);
    needed += crowd::bytesOf(crowd, herd, from.agents);
  }
  const uint64_t available = gpu::availableBytes(context.physical());
  if (needed > available)
    throw deviceError(std::to_string(agents) + " agents need " + gibibytes(needed) + ", " +
                      context.report().name + " has " + gibibytes(available) + " available");
  if (agents > kMostAgents)
    throw inputError(std::to_string(agents) + " agents, expected at most " + std::to_string(kMostAgents));

  for (size_t h = 0; h < crowd.herds.size(); ++h) {
    crowd::Herd& herd = crowd.herds[h];
    const Herd& from = scene.herds[h];
    crowd::makeKernels(context, options, herd);
    const crowd::Spawner spawner(from, herd, terrain, scene.seed + (uint64_t{h} << 32));
    herd.pages = crowd::makePages(crowd, herd, spawner, from.agents);
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
  const uint64_t tick = ++crowd.tick;

  crowd.timer.reset(cmd);
  gpu::graphicsToCompute(cmd);
  gpu::computeToTransfer(cmd);
  clearLists(crowd, cmd);
  clearAwake(crowd, cmd);
  if (!crowd.edits.empty()) crowd.edits.record(cmd, crowd.terrain, crowd.heights);
  gpu::transferToCompute(cmd);
  const char* last = nullptr;
  for (const std::string_view name : crowd::frame()) {
    if (!hasStage(crowd, name)) continue;
    crowd.timer.next(cmd, last = name.data());
    recordStage(crowd, name, tick, cmd);
    if (crowd::makes(name, "gait") || name == "wake")
      gpu::computeToIndirectAndCompute(cmd);
    else
      gpu::computeToCompute(cmd);
  }
  if (last != nullptr) crowd.timer.end(cmd, last);
  gpu::computeToGraphics(cmd);
  gpu::computeToTransfer(cmd);
}

uint64_t Crowd::tick() const { return impl_->tick; }
uint32_t Crowd::watchEvery() const { return impl_->watchEvery; }
uint32_t Crowd::herdCount() const { return static_cast<uint32_t>(impl_->herds.size()); }
const Rig& Crowd::rig(uint32_t herd) const { return impl_->herds.at(herd).rig; }

uint64_t Crowd::agentCount() const {
  uint64_t count = 0;
  for (const crowd::Herd& herd : impl_->herds)
    for (const Page& page : herd.pages) count += page.agents;
  return count;
}

std::vector<MemoryUse> Crowd::memoryUse(uint32_t herdIndex) const {
  const crowd::Herd& herd = impl_->herds.at(herdIndex);
  std::vector<MemoryUse> uses;
  for (const crowd::PageBuffer& each : crowd::pageBuffers(*impl_, herd)) {
    MemoryUse& use = uses.emplace_back(MemoryUse{each.name});
    for (const Page& page : herd.pages) use.bytes += (page.*each.buffer).size();
  }
  return uses;
}

uint64_t Crowd::memoryBytes() const {
  uint64_t bytes = 0;
  for (uint32_t h = 0; h < herdCount(); ++h)
    for (const MemoryUse& use : memoryUse(h)) bytes += use.bytes;
  return bytes;
}

void Crowd::timeStages(bool on) { impl_->timer.measure(on); }

std::vector<StageTime> Crowd::stageTimes() const {
  std::vector<StageTime> times;
  if (!impl_->timer.measures()) return times;
  impl_->context->waitIdle();
  for (const gpu::StageTime& t : impl_->timer.milliseconds()) times.push_back({t.stage, t.milliseconds});
  return times;
}

}  // namespace skitter

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

#include "crowd/controllers/controllers.h"
#include "crowd/events.h"
#include "crowd/frame.h"
#include "crowd/herd.h"
#include "crowd/kinds.h"
#include "crowd/page.h"
#include "crowd/rig_records.h"
#include "crowd/scale.h"
#include "crowd/spawn.h"
#include "crowd/stage.h"
#include "crowd/tint.h"
#include "crowd/tuning.h"
#include "crowd/watch.h"
#include "gpu/barrier.h"
#include "gpu/context.h"
#include "gpu/device_memory.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "skitter/error.h"

namespace skitter {
namespace {

using crowd::Page;
using crowd::Stage;
using Impl = Crowd::Impl;

// The chains start at rest and must reach their feet before the first tick.
constexpr int settleIterations = 6;
static_assert(shared::MOST_LEGS == Rig::maxLegs);

std::string gibibytes(uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f GiB", static_cast<double>(bytes) / (1 << 30));
  return text;
}

// Every pipeline runs once with nothing to do, so that no tick pays for its translation to machine code, and
// the chains are brought to their feet.
void settle(Impl& crowd) {
  using enum crowd::StageId;
  gpu::submitAndWait(*crowd.context, [&](vk::CommandBuffer cmd) {
    crowd::clearLists(crowd, cmd);
    crowd::clearAwake(crowd, cmd);
    gpu::transferToCompute(cmd);
    const shared::TickConstants nothing{};
    for (const crowd::Kind& kind : crowd.kinds)
      for (size_t i = 0; i < kind.stages.size(); ++i)
        for (const gpu::Kernel* kernel :
             {&kind.stages[i].first, &kind.stages[i].afterEdit, &kind.stages[i].listed}) {
          if (!*kernel) continue;
          for (const Page& page : kind.pages)
            kernel->dispatch(cmd, page.bindings[i], gpu::bytesOf(nothing), 1);
          gpu::computeToCompute(cmd);
        }
    const crowd::Frame frame(crowd, 0, cmd);
    frame.record(wake);
    gpu::computeToIndirectAndCompute(cmd);
    frame.record(swing);
    for (int i = 0; i < settleIterations; ++i) {
      gpu::computeToCompute(cmd);
      gpu::computeToTransfer(cmd);
      crowd::clearLists(crowd, cmd);  // ik lists legs each time
      gpu::transferToCompute(cmd);
      frame.record(ik);
      frame.record({swing, ik});
    }
    gpu::computeToCompute(cmd);
    frame.record(pose);
    frame.record(footfall);  // remembers which feet are in the air
  });
}

shared::Parameters parametersOf(const Impl& crowd, const crowd::Kind& kind, float dt) {
  shared::Parameters parameters = crowd::tuningFor(kind.tuning, kind.rig, kind.ik, crowd.terrain, dt);
  parameters.poseKeys = static_cast<float>(kind.keyPoses.keys);
  parameters.poseStride = kind.keyPoses.stride;
  parameters.reachTriggered = parameters.nearestOnly = kind.reachTriggered ? 1.0f : 0.0f;
  return parameters;
}

void setParameters(const Impl& crowd, float dt, crowd::Kind& kind) {
  kind.parameters = parametersOf(crowd, kind, dt);
  std::memcpy(kind.parameterBlock.bytes().data(), &kind.parameters, sizeof kind.parameters);
}

void setTick(Impl& crowd, float dt) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw inputError("dt " + std::to_string(dt) + ": expected a finite time above 0");
  if (crowd.dt == dt) return;
  if (crowd.dt != 0)
    throw inputError("dt changed from " + std::to_string(crowd.dt) + " to " + std::to_string(dt) +
                     ": steps are timed in ticks, so a crowd keeps its first dt");
  for (const crowd::Kind& kind : crowd.kinds) {
    const auto check = crowd::controllerStages(kind.controller).checkTick;
    if (check != nullptr) check(kind, dt);
  }
  crowd.dt = dt;
  for (crowd::Kind& kind : crowd.kinds) setParameters(crowd, dt, kind);
}

// All of a kind but its agents; `made` is its rig at size 1.
crowd::Kind makeKind(const Impl& crowd, const Herd& from, const Rig& made, float size) {
  const gpu::Context& context = *crowd.context;
  crowd::Kind kind;
  kind.controller = from.controller;
  kind.size = size;
  kind.rig = crowd::scaled(made, size);
  kind.legs = kind.rig.legCount();
  kind.bones = kind.rig.maxBones();
  kind.groups = kind.rig.groupCount();
  if (kind.rig.legs.size() > Rig::maxLegs)
    throw inputError(kind.rig.name + ": " + std::to_string(kind.legs) + " legs, expected at most " +
                     std::to_string(Rig::maxLegs));
  kind.ik = crowd::ikPlanFor(from.solver);
  kind.tuning = from.tuning;
  kind.rigRecords = crowd::rigRecords(kind.rig);
  kind.rigBuffer = gpu::Buffer(context, kind.rigRecords.size() * sizeof(float), "rig");
  gpu::upload(context, kind.rigBuffer, kind.rigRecords);
  const auto prepare = crowd::controllerStages(kind.controller).prepare;
  if (prepare != nullptr) prepare(context, from, made, kind);
  kind.parameterBlock =
      gpu::HostBuffer(context, sizeof(shared::Parameters), gpu::HostUse::upload, "parameters");
  setParameters(crowd, 1.0f / 60, kind);
  for (const Stage& stage : crowd::stagesOf(kind.controller, crowd.options)) kind.stages.push_back({stage});
  return kind;
}

// The crowd's herds, and how many agents each kind has.
void addHerds(Impl& crowd, const Scene& scene, const crowd::Kinds& kinds, const crowd::SpawnPlaces& places) {
  uint32_t ofScene = 0;  // agents of the scene's herd so far
  for (const crowd::SizedHerd& from : kinds.herds) {
    if (from.place == 0) {
      crowd.firstHerds.push_back(static_cast<uint32_t>(crowd.herds.size()));
      ofScene = 0;
    }
    crowd::Kind& kind = crowd.kinds[from.kind];
    const uint32_t agents = places.count(from.herd, from.place);
    crowd.herds.push_back({.kind = from.kind,
                           .place = static_cast<uint32_t>(kind.firstAgents.size()),
                           .firstAgent = static_cast<uint32_t>(kind.agents),
                           .agents = agents,
                           .ofScene = from.herd,
                           .firstOfScene = ofScene});
    kind.tinted = kind.tinted || (crowd.options.pose && crowd::isTinted(scene.herds[from.herd]));
    kind.firstAgents.push_back(kind.agents);
    kind.agents += agents;
    ofScene += agents;
  }
  crowd.firstHerds.push_back(static_cast<uint32_t>(crowd.herds.size()));
}

// Of the agents of a kind that some herd has coloured.
void uploadTints(const Impl& crowd, const Scene& scene, uint32_t kind) {
  const float lightness = crowd::meanLightness(crowd.kinds[kind]);
  for (uint32_t h = 0; h < scene.herds.size(); ++h)
    for (const crowd::Part& part : crowd::partsOf(crowd, h)) {
      if (part.kind != &crowd.kinds[kind]) continue;
      const std::vector<glm::vec4> tints =
          crowd::tintsOf(scene.herds[h], part, crowd::seedOf(scene, h), lightness);
      gpu::uploadBytes(*crowd.context, part.page->tint, std::as_bytes(std::span(tints)),
                       part.first * sizeof(glm::vec4));
    }
}

std::unique_ptr<Impl> makeCrowd(Device& device, const Heightfield& terrain, const Scene& scene,
                                crowd::Kinds kinds, const CrowdOptions& options) {
  auto made = std::make_unique<Impl>();
  Impl& crowd = *made;
  const gpu::Context& context = device.context();
  crowd.context = &context;
  crowd.options = options;
  if (std::max(terrain.extentX(), terrain.extentZ()) > 2 * Scene::maxCoordinate)
    throw inputError(terrain.name + ": the terrain is " +
                     std::to_string(static_cast<int>(terrain.extentX())) + " x " +
                     std::to_string(static_cast<int>(terrain.extentZ())) + " m, expected at most " +
                     std::to_string(static_cast<int>(2 * Scene::maxCoordinate)) +
                     " m a side; --scale or the scene's scale makes it smaller");
  crowd.terrain = terrain;
  crowd.heights = gpu::Image(
      context, {vk::Format::eR32Sfloat, {terrain.columns, terrain.rows}, vk::ImageUsageFlagBits::eSampled},
      "heights");
  gpu::uploadImage(context, crowd.heights, terrain.heights);
  crowd.edits = crowd::HeightEdits(context);
  crowd::checkEvents(scene, terrain);
  crowd.events = scene.events;
  if (options.timestamps) crowd.timer = gpu::StageTimer(context, crowd::Frame::mostStages);

  const uint64_t agents = scene.agentCount();
  crowd.watchEvery = crowd::watchEvery(options, agents);
  for (size_t k = 0; k < kinds.rigs.size(); ++k) {
    const crowd::SizedHerd& first = kinds.herds[kinds.firstHerds[k]];
    crowd.kinds.push_back(makeKind(crowd, scene.herds[first.herd], kinds.rigs[k], first.size));
  }
  const crowd::SpawnPlaces places(scene);
  addHerds(crowd, scene, kinds, places);
  uint64_t needed = 0;
  for (crowd::Kind& kind : crowd.kinds) {
    kind.herdSteps = crowd::herdStepsOf(crowd, kind);
    needed += crowd::bytesOf(crowd, kind);
  }
  const gpu::FreeMemory available = gpu::availableMemory(context.physical());
  if (needed > available.bytes)
    throw deviceError(std::to_string(agents) + " agents need " + gibibytes(needed) + ", " +
                      context.report().name + " has " + gibibytes(available.bytes) + " available (" +
                      available.of + ")");
  if (agents > Scene::maxAgents)
    throw inputError(std::to_string(agents) + " agents, expected at most " +
                     std::to_string(Scene::maxAgents));

  for (size_t k = 0; k < crowd.kinds.size(); ++k) {
    crowd::Kind& kind = crowd.kinds[k];
    for (crowd::ReadyStage& stage : kind.stages) crowd::makeKernels({context, options, kind}, stage);
    std::vector<crowd::Spawner> spawners;
    for (const crowd::SizedHerd& from : kinds.herds)
      if (from.kind == k)
        spawners.emplace_back(scene.herds[from.herd], kind, terrain, crowd::seedOf(scene, from.herd),
                              places.of(from.herd, from.place));
    kind.pages = crowd::makePages(crowd, kind, spawners);
    if (kind.tinted) uploadTints(crowd, scene, static_cast<uint32_t>(k));
  }
  settle(crowd);
  return made;
}

}  // namespace

Crowd::Crowd(Device& device, const Heightfield& terrain, const Scene& scene, const CrowdOptions& options)
    : impl_(makeCrowd(device, terrain, scene, crowd::kindsOf(scene), options)) {}

Crowd::Crowd(Device& device, const Heightfield& terrain, const Scene& scene, std::vector<Rig> rigs,
             const CrowdOptions& options)
    : impl_(makeCrowd(device, terrain, scene, crowd::kindsOf(scene, std::move(rigs)), options)) {}

Crowd::~Crowd() = default;
Crowd::Crowd(Crowd&&) noexcept = default;
Crowd& Crowd::operator=(Crowd&&) noexcept = default;

void Crowd::record(VkCommandBuffer commandBuffer, float dt) {
  Impl& crowd = *impl_;
  const vk::CommandBuffer cmd(commandBuffer);
  setTick(crowd, dt);
  for (const Event& event : crowd::eventsAt(crowd.events, crowd.tick + 1, double{dt}))
    crowd::happen(event, *this);
  const uint64_t tick = ++crowd.tick;

  crowd.timer.reset(cmd);
  gpu::graphicsToCompute(cmd);
  gpu::computeToTransfer(cmd);
  crowd::clearLists(crowd, cmd);
  crowd::clearAwake(crowd, cmd);
  if (!crowd.edits.empty()) crowd.edits.record(cmd, crowd.terrain, crowd.heights);
  gpu::transferToCompute(cmd);
  const crowd::Frame frame(crowd, tick, cmd);
  const char* last = nullptr;
  const auto run = [&](crowd::StageSet stage, void (*barrier)(vk::CommandBuffer)) {
    const char* name = frame.nameOf(stage);
    if (name == nullptr) return;  // no kind has it
    crowd.timer.next(cmd, last = name);
    frame.record(stage);
    barrier(cmd);
  };
  // After stages that count what the next ones are dispatched over.
  constexpr auto counted = gpu::computeToIndirectAndCompute;
  constexpr auto written = gpu::computeToCompute;
  using enum crowd::StageId;
  run(navigate, written);
  run(wake, counted);
  run(body, written);
  run({navigate, body, gait}, counted);
  run({body, gait}, counted);
  run(clip, written);
  run(gait, counted);
  run(foothold, written);
  run(swing, written);
  run({swing, ik}, written);
  run(ik, written);
  run(pose, written);
  run(measure, written);
  run(footfall, written);
  if (last != nullptr) crowd.timer.end(cmd, last);
  gpu::computeToGraphics(cmd);
  gpu::computeToTransfer(cmd);
}

const crowd::Herd& Crowd::Impl::sizeOf(uint32_t herd, uint32_t agent) const {
  const std::span<const crowd::Herd> sizes = sizesOf(herd);
  return *(std::ranges::upper_bound(sizes, agent, {}, &crowd::Herd::firstOfScene) - 1);
}

uint64_t Crowd::tick() const { return impl_->tick; }
uint32_t Crowd::watchEvery() const { return impl_->watchEvery; }
uint32_t Crowd::herdCount() const { return static_cast<uint32_t>(impl_->firstHerds.size()) - 1; }
const Rig& Crowd::rig(uint32_t herd) const { return impl_->kindOf(herd).rig; }
const Rig& Crowd::rig(uint32_t herd, uint32_t agent) const {
  return impl_->kindOf(impl_->sizeOf(herd, agent)).rig;
}
float Crowd::size(uint32_t herd, uint32_t agent) const {
  return impl_->kindOf(impl_->sizeOf(herd, agent)).size;
}

uint64_t Crowd::agentCount() const {
  uint64_t count = 0;
  for (const crowd::Kind& kind : impl_->kinds) count += kind.agents;
  return count;
}

std::vector<MemoryUse> Crowd::memoryUse(uint32_t herdIndex) const {
  std::vector<MemoryUse> uses;
  for (const crowd::Herd& herd : impl_->sizesOf(herdIndex)) {
    const crowd::Kind& kind = impl_->kindOf(herd);
    for (const crowd::PageBuffer& each : crowd::pageBuffers(*impl_, kind)) {
      uint64_t bytes = 0;
      for (const Page& page : kind.pages) bytes += each.in(page).size();
      // What agents before the herd's end take, less what those before its beginning do: all shares are the
      // whole.
      const auto upTo = [&](uint64_t agents) { return kind.agents > 0 ? bytes * agents / kind.agents : 0; };
      const uint64_t share = upTo(herd.firstAgent + herd.agents) - upTo(herd.firstAgent);
      const auto same = std::ranges::find(uses, each.name, &MemoryUse::name);
      if (same == uses.end())
        uses.push_back({each.name, share});
      else
        same->bytes += share;
    }
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

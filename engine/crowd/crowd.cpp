#include "skitter/crowd.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include "crowd/controllers/controllers.h"
#include "crowd/events.h"
#include "crowd/frame.h"
#include "crowd/herd.h"
#include "crowd/kinds.h"
#include "crowd/page.h"
#include "crowd/rig_records.h"
#include "crowd/setup.h"
#include "crowd/spawn.h"
#include "crowd/stage.h"
#include "crowd/state.h"
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

static_assert(shared::MOST_LEGS == Rig::maxLegs);

std::string gibibytes(uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f GiB", static_cast<double>(bytes) / (1 << 30));
  return text;
}

// Every pipeline runs once with nothing to do, so that no tick pays for its translation to machine code.
void warmUp(const Impl& crowd, std::span<const crowd::Kind> kinds) {
  gpu::submitAndWait(*crowd.context, [&](vk::CommandBuffer cmd) {
    crowd::clearLists(kinds, cmd);
    crowd::clearAwake(crowd, kinds, cmd);
    gpu::transferToCompute(cmd);
    const shared::TickConstants nothing{};
    for (const crowd::Kind& kind : kinds)
      for (size_t i = 0; i < kind.stages.size(); ++i)
        for (const gpu::Kernel* kernel :
             {&kind.stages[i].first, &kind.stages[i].afterEdit, &kind.stages[i].listed}) {
          if (!*kernel) continue;
          for (const Page& page : kind.pages)
            kernel->dispatch(cmd, page.bindings[i], gpu::bytesOf(nothing), 1);
          gpu::computeToCompute(cmd);
        }
  });
}

// The chains of agents that have just been spawned are brought to their feet.
void settle(const Impl& crowd, std::span<const crowd::Kind> kinds) {
  using enum crowd::StageId;
  warmUp(crowd, kinds);
  gpu::submitAndWait(*crowd.context, [&](vk::CommandBuffer cmd) {
    crowd::clearLists(kinds, cmd);
    crowd::clearAwake(crowd, kinds, cmd);
    gpu::transferToCompute(cmd);
    const crowd::Frame frame(crowd, kinds, 0, cmd);
    frame.record(wake);
    gpu::computeToIndirectAndCompute(cmd);
    frame.record(swing);
    for (int i = 0; i < crowd::settleIterations; ++i) {
      gpu::computeToCompute(cmd);
      gpu::computeToTransfer(cmd);
      crowd::clearLists(kinds, cmd);  // ik lists legs each time
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

void checkTick(const crowd::Kind& kind, float dt) {
  const auto check = crowd::controllerStages(kind.controller).checkTick;
  if (check != nullptr && !kind.stages.empty()) check(kind, dt);
}

// All of a kind but its agents.
crowd::Kind makeKind(const Impl& crowd, const Herd& from, Rig rig) {
  const gpu::Context& context = *crowd.context;
  crowd::Kind kind;
  kind.controller = from.controller;
  kind.rig = std::move(rig);
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
  if (prepare != nullptr) prepare(context, from, kind);
  kind.parameterBlock =
      gpu::HostBuffer(context, sizeof(shared::Parameters), gpu::HostUse::upload, "parameters");
  crowd::setParameters(crowd, crowd::usualDt, kind);
  kind.reserves = from.reserve > 0;
  CrowdOptions asked = crowd.options;
  asked.sleep = kind.rests(asked);
  for (const Stage& stage : crowd::stagesOf(kind.controller, asked)) kind.stages.push_back({stage});
  return kind;
}

uint64_t seedOf(const Impl& crowd, size_t herd) { return crowd.seed + (uint64_t{herd} << 32); }

void expectMemory(const gpu::Context& context, uint64_t agents, uint64_t needed) {
  const gpu::FreeMemory available = gpu::availableMemory(context.physical());
  if (needed > available.bytes)
    throw deviceError(std::to_string(agents) + " agents need " + gibibytes(needed) + ", " +
                      context.report().name + " has " + gibibytes(available.bytes) + " available (" +
                      available.of + ")");
}

// Of the agents of a kind that some herd has coloured.
void uploadTints(const Impl& crowd, uint32_t kind) {
  const float lightness = crowd::meanLightness(crowd.kinds[kind]);
  for (uint32_t h = 0; h < crowd.herds.size(); ++h) {
    const crowd::Herd& herd = crowd.herds[h];
    if (herd.kind != kind) continue;
    for (const crowd::Part& part : crowd::partsOf(crowd, h)) {
      const std::vector<glm::vec4> tints = crowd::tintsOf(herd.from, part, herd.seed, lightness);
      gpu::uploadBytes(*crowd.context, part.page->tint, std::as_bytes(std::span(tints)),
                       part.first * sizeof(glm::vec4));
    }
  }
}

// The kind's pipelines, and its agents: where they begin, or zeros.
void fill(Impl& crowd, uint32_t k, bool spawns = true) {
  crowd::Kind& kind = crowd.kinds[k];
  for (crowd::ReadyStage& stage : kind.stages)
    crowd::makeKernels({*crowd.context, crowd.options, kind}, stage);
  std::vector<crowd::Spawner> spawners;
  for (const crowd::Herd& herd : crowd.herds)
    if (herd.kind == k && spawns) spawners.emplace_back(herd.from, kind, crowd.terrain, herd.seed);
  kind.pages = crowd::makePages(crowd, kind, spawners);
  if (kind.tinted) uploadTints(crowd, k);
}

// A crowd without herds.
std::unique_ptr<Impl> beginCrowd(Device& device, const Heightfield& terrain, const Scene& scene,
                                 const CrowdOptions& options) {
  auto made = std::make_unique<Impl>();
  Impl& crowd = *made;
  const gpu::Context& context = device.context();
  crowd.context = &context;
  crowd.options = options;
  crowd.rigsAreCallers = !options.rigs.empty();
  crowd.options.rigs = {};  // each kind has its own
  crowd.seed = scene.seed;
  crowd.scene = scene;
  crowd.scene.herds = {};  // each has its own
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
  gpu::uploadImage(context, crowd.heights, terrain.heights, gpu::sampledOn(context));
  crowd.edits = crowd::HeightEdits(context);
  crowd.events = scene.events;
  if (options.timestamps) crowd.timer = gpu::StageTimer(context, crowd::Frame::mostStages);
  crowd.watchEvery = crowd::watchEvery(options, scene.capacity());
  return made;
}

// The kinds' pipelines and agents, once herds and kinds have their places.
void fillAll(Impl& crowd, bool spawn) {
  uint64_t needed = 0, agents = 0;
  for (crowd::Kind& kind : crowd.kinds) {
    if (kind.stages.empty()) continue;
    kind.herdSteps = crowd::herdStepsOf(crowd, kind);
    needed += crowd::bytesOf(crowd, kind);
    agents += kind.agents;
  }
  expectMemory(*crowd.context, agents, needed);
  if (agents > Scene::maxAgents)
    throw inputError(std::to_string(agents) + " agents, expected at most " +
                     std::to_string(Scene::maxAgents));
  for (uint32_t k = 0; k < crowd.kinds.size(); ++k)
    if (!crowd.kinds[k].stages.empty()) fill(crowd, k, spawn);
}

std::unique_ptr<Impl> makeCrowd(Device& device, const Heightfield& terrain, const Scene& scene,
                                crowd::Kinds kinds, const CrowdOptions& options) {
  // A state's were checked when its crowd began, with the herds that there were then.
  crowd::checkEvents(scene, terrain);
  auto made = beginCrowd(device, terrain, scene, options);
  Impl& crowd = *made;
  for (size_t k = 0; k < kinds.rigs.size(); ++k)
    crowd.kinds.push_back(makeKind(crowd, scene.herds[kinds.firstHerds[k]], std::move(kinds.rigs[k])));
  for (size_t h = 0; h < scene.herds.size(); ++h) {
    crowd::Kind& kind = crowd.kinds[kinds.ofHerds[h]];
    crowd.herds.push_back(
        {.kind = kinds.ofHerds[h],
         .place = static_cast<uint32_t>(kind.firstAgents.size()),
         .firstAgent = static_cast<uint32_t>(kind.agents),
         .agents = scene.herds[h].agents + scene.herds[h].reserve,
         .presence = {scene.herds[h].agents, scene.herds[h].agents + scene.herds[h].reserve},
         .from = scene.herds[h],
         .seed = seedOf(crowd, h)});
    kind.tinted = kind.tinted || (options.pose && crowd::isTinted(scene.herds[h]));
    kind.firstAgents.push_back(kind.agents);
    kind.agents += crowd.herds.back().agents;
  }
  fillAll(crowd, true);
  settle(crowd, crowd.kinds);
  return made;
}

// The rig of a herd alone.
Rig rigFor(const Herd& from) {
  Scene scene;
  scene.name = "a new herd";
  scene.herds = {from};
  return std::move(crowd::kindsOf(scene).rigs.front());
}

// Herds and kinds have the numbers that they had, those that are gone among them.
std::unique_ptr<Impl> remakeCrowd(Device& device, const State& state) {
  auto made = beginCrowd(device, state.terrain, state.scene, state.options);
  Impl& crowd = *made;
  crowd::restoreHerds(crowd, state);
  for (uint32_t k = 0; k < crowd.kinds.size(); ++k) {
    const auto first = std::ranges::find_if(
        crowd.herds, [&](const crowd::Herd& herd) { return herd.kind == k && herd.generation % 2 == 0; });
    if (first == crowd.herds.end()) continue;
    const auto h = static_cast<size_t>(first - crowd.herds.begin());
    crowd::Kind kind = makeKind(crowd, first->from,
                                state.options.rigs.empty() ? rigFor(first->from) : state.options.rigs[h]);
    kind.firstAgents = std::move(crowd.kinds[k].firstAgents);
    kind.agents = crowd.kinds[k].agents;
    for (const crowd::Herd& herd : crowd.herds)
      if (herd.kind == k && herd.generation % 2 == 0)
        kind.tinted = kind.tinted || (state.options.pose && crowd::isTinted(herd.from));
    crowd.kinds[k] = std::move(kind);
  }
  for (size_t h = 0; h < crowd.herds.size(); ++h) crowd.herds[h].seed = seedOf(crowd, h);
  crowd::checkState(crowd, state);
  fillAll(crowd, false);
  warmUp(crowd, crowd.kinds);
  crowd::restore(crowd, state);
  return made;
}

// A kind for that herd alone, without its pipelines and agents.
crowd::Kind kindFor(const Impl& crowd, const Herd& from) {
  crowd::Kind kind = makeKind(crowd, from, rigFor(from));
  if (crowd.dt > 0) {
    checkTick(kind, crowd.dt);
    crowd::setParameters(crowd, crowd.dt, kind);
  }
  kind.tinted = crowd.options.pose && crowd::isTinted(from);
  kind.firstAgents = {0};
  kind.agents = uint64_t{from.agents} + from.reserve;
  kind.herdSteps = crowd::herdStepsOf(crowd, kind);
  return kind;
}

bool isGone(const crowd::Herd& herd) { return herd.generation % 2 == 1; }

// The first of them that is free, or a new last one.
template <class List, class IsFree>
uint32_t slotIn(List& list, const IsFree& isFree) {
  const auto at = static_cast<uint32_t>(std::ranges::find_if(list, isFree) - list.begin());
  if (at == list.size()) list.emplace_back();
  return at;
}

void vacate(Impl& crowd, uint32_t number) {
  crowd::Herd& herd = crowd.herds[number];
  herd.agents = herd.presence.count = 0;
  ++herd.generation;
  ++crowd.revision;
}

}  // namespace

namespace crowd {

void setParameters(const Crowd::Impl& crowd, float dt, Kind& kind) {
  kind.parameters = parametersOf(crowd, kind, dt);
  std::memcpy(kind.parameterBlock.bytes().data(), &kind.parameters, sizeof kind.parameters);
}

void setTick(Crowd::Impl& crowd, float dt) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw inputError("dt " + std::to_string(dt) + ": expected a finite time above 0");
  if (crowd.dt == dt) return;
  if (crowd.dt != 0)
    throw inputError("dt changed from " + std::to_string(crowd.dt) + " to " + std::to_string(dt) +
                     ": steps are timed in ticks, so a crowd keeps its first dt");
  for (const Kind& kind : crowd.kinds) checkTick(kind, dt);
  crowd.dt = dt;
  for (Kind& kind : crowd.kinds)
    if (!kind.stages.empty()) setParameters(crowd, dt, kind);
}

}  // namespace crowd

Crowd::Crowd(Device& device, const Heightfield& terrain, const Scene& scene, const CrowdOptions& options)
    : impl_(makeCrowd(device, terrain, scene,
                      options.rigs.empty() ? crowd::kindsOf(scene) : crowd::kindsOf(scene, options.rigs),
                      options)) {}

Crowd::Crowd(Device& device, const State& state) : impl_(remakeCrowd(device, state)) {}

Crowd::~Crowd() = default;
Crowd::Crowd(Crowd&&) noexcept = default;
Crowd& Crowd::operator=(Crowd&&) noexcept = default;

void Crowd::record(VkCommandBuffer commandBuffer, float dt) {
  Impl& crowd = *impl_;
  const vk::CommandBuffer cmd(commandBuffer);
  crowd::setTick(crowd, dt);
  crowd::letEventsHappen(*this);
  const uint64_t tick = ++crowd.tick;
  crowd.agentsInTick = agentCount();

  crowd.timer.reset(cmd);
  if (crowd.context->draws()) gpu::graphicsToCompute(cmd);
  gpu::computeToTransfer(cmd);
  crowd::clearLists(crowd.kinds, cmd);
  crowd::clearAwake(crowd, crowd.kinds, cmd);
  if (!crowd.edits.empty())
    crowd.edits.record(cmd, crowd.terrain, crowd.heights, gpu::sampledOn(*crowd.context));
  crowd::recordChanges(crowd, cmd);
  gpu::transferToCompute(cmd);
  const crowd::Frame frame(crowd, crowd.kinds, tick, cmd);
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
  if (crowd.context->draws()) gpu::computeToGraphics(cmd);
  gpu::computeToTransfer(cmd);
}

const crowd::Herd& Crowd::Impl::herdAt(uint32_t herd) const {
  if (herd < herds.size()) return herds[herd];
  throw inputError(fmt::format("herd {}: expected one of the crowd's {} herds", herd, herds.size()));
}

HerdId Crowd::addHerd(const Herd& from) {
  Impl& crowd = *impl_;
  const uint64_t places = uint64_t{from.agents} + from.reserve, held = capacity();
  if (held + places > Scene::maxAgents)
    throw inputError(
        fmt::format("a new herd: {} agents and reserve beside {} places, expected at most {} in all", places,
                    held, Scene::maxAgents));
  const auto live = std::ranges::count_if(crowd.herds, [](const auto& herd) { return !isGone(herd); });
  if (static_cast<size_t>(live) >= Scene::maxHerds)
    throw inputError(fmt::format("a new herd beside {}, expected at most {} in all", live, Scene::maxHerds));
  const auto kinds =
      std::ranges::count_if(crowd.kinds, [](const auto& kind) { return !kind.stages.empty(); });
  if (static_cast<size_t>(kinds) >= crowd::mostKinds)
    throw inputError(
        fmt::format("a new herd, which is of a kind of its own, beside {} kinds, expected at most {}", kinds,
                    crowd::mostKinds));
  crowd::Kind made = kindFor(crowd, from);
  expectMemory(*crowd.context, places, crowd::bytesOf(crowd, made));

  const uint32_t k = slotIn(crowd.kinds, [](const auto& kind) { return kind.stages.empty(); });
  const uint32_t number = slotIn(crowd.herds, isGone);
  crowd.kinds[k] = std::move(made);
  crowd::Herd& herd = crowd.herds[number];
  herd = {.kind = k,
          .agents = static_cast<uint32_t>(places),
          .presence = {from.agents, static_cast<uint32_t>(places), herd.presence.nextGeneration()},
          .from = from,
          .seed = seedOf(crowd, number),
          .generation = (herd.generation + 1) / 2 * 2};
  try {
    fill(crowd, k);
    settle(crowd, std::span(&crowd.kinds[k], 1));
    gpu::submitAndWait(*crowd.context, [&](vk::CommandBuffer cmd) {
      gpu::allToAll(cmd);
      crowd::beginWatch(crowd, crowd.kinds[k], cmd);
      gpu::allToAll(cmd);
    });
  } catch (...) {
    crowd.kinds[k] = {};
    vacate(crowd, number);
    throw;
  }
  ++crowd.revision;
  return {number, herd.generation};
}

void Crowd::removeHerd(HerdId id) {
  Impl& crowd = *impl_;
  if (!has(id))
    throw inputError(fmt::format("herd {} of generation {}: expected one of those that are there", id.index,
                                 id.generation));
  const uint32_t k = crowd.herds[id.index].kind;
  const bool alone = std::ranges::count_if(crowd.herds, [&](const crowd::Herd& herd) {
                       return herd.kind == k && !isGone(herd);
                     }) == 1;
  if (!alone && !crowd.kinds[k].reserves)
    throw inputError(fmt::format(
        "herd {}: shares pages with other herds, expected a herd of another kind or one with a reserve",
        id.index));
  crowd.context->waitIdle();
  if (alone)
    crowd.kinds[k] = {};
  else
    for (uint32_t agent = 0; agent < places(id.index); ++agent)
      if (crowd.herds[id.index].presence.has(agent)) remove(agentId(id.index, agent));
  vacate(crowd, id.index);
}

bool Crowd::has(HerdId id) const {
  return id.index < impl_->herds.size() && impl_->herds[id.index].generation == id.generation &&
         !isGone(impl_->herds[id.index]);
}

HerdId Crowd::herdId(uint32_t herd) const {
  const HerdId id{herd, impl_->herdAt(herd).generation};
  if (!has(id)) throw inputError(fmt::format("herd {}: was removed", herd));
  return id;
}

uint64_t Crowd::tick() const { return impl_->tick; }
uint32_t Crowd::watchEvery() const { return impl_->watchEvery; }
uint32_t Crowd::herdCount() const { return static_cast<uint32_t>(impl_->herds.size()); }
const Rig& Crowd::rig(uint32_t herd) const { return impl_->kindOf(herd).rig; }

uint64_t Crowd::agentCount() const {
  uint64_t count = 0;
  for (const crowd::Herd& herd : impl_->herds) count += herd.presence.count;
  return count;
}

uint64_t Crowd::capacity() const {
  uint64_t count = 0;
  for (const crowd::Herd& herd : impl_->herds) count += herd.agents;
  return count;
}

std::vector<MemoryUse> Crowd::memoryUse(uint32_t herdIndex) const {
  const crowd::Herd& herd = impl_->herdAt(herdIndex);
  const crowd::Kind& kind = impl_->kinds[herd.kind];
  std::vector<MemoryUse> uses;
  for (const crowd::PageBuffer& each : crowd::pageBuffers(*impl_, kind)) {
    uint64_t bytes = 0;
    for (const Page& page : kind.pages) bytes += each.in(page).size();
    // What agents before the herd's end take, less what those before its beginning do: all shares are the
    // whole.
    const auto upTo = [&](uint64_t agents) { return kind.agents > 0 ? bytes * agents / kind.agents : 0; };
    uses.push_back({each.name, upTo(herd.firstAgent + herd.agents) - upTo(herd.firstAgent)});
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

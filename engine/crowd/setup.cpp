#include "crowd/setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "crowd/changes.h"
#include "crowd/controllers/controllers.h"
#include "crowd/events.h"
#include "crowd/frame.h"
#include "crowd/grid.h"
#include "crowd/herd.h"
#include "crowd/kinds.h"
#include "crowd/levels.h"
#include "crowd/page.h"
#include "crowd/rig_records.h"
#include "crowd/roster.h"
#include "crowd/scale.h"
#include "crowd/spawn.h"
#include "crowd/stage.h"
#include "crowd/state.h"
#include "crowd/steer.h"
#include "crowd/tint.h"
#include "crowd/tuning.h"
#include "crowd/walls.h"
#include "crowd/watch.h"
#include "crowd/ways/trails.h"
#include "crowd/ways/ways.h"
#include "crowd/world_checks.h"
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

// All of a kind but its agents; `loaded` is its rig at size 1.
crowd::Kind makeKind(const Impl& crowd, const Herd& from, const Rig& loaded, float size) {
  crowd::checkRig(loaded);
  const gpu::Context& context = *crowd.context;
  crowd::Kind kind;
  kind.controller = from.controller;
  kind.size = size;
  kind.rig = crowd::scaled(loaded, size);
  kind.legs = kind.rig.legCount();
  kind.bones = kind.rig.maxBones();
  kind.groups = kind.rig.groupCount();
  kind.ik = crowd::ikPlanFor(from.solver);
  kind.tuning = from.tuning;
  kind.rigRecords = crowd::rigRecords(kind.rig);
  kind.rigBuffer = gpu::Buffer(context, kind.rigRecords.size() * sizeof(float), "rig");
  gpu::upload(context, kind.rigBuffer, kind.rigRecords);
  const auto prepare = crowd::controllerStages(kind.controller).prepare;
  if (prepare != nullptr) prepare(context, from, loaded, kind);
  kind.parameterBlock =
      gpu::HostBuffer(context, sizeof(shared::Parameters), gpu::HostUse::upload, "parameters");
  crowd::setParameters(crowd, crowd::usualDt, kind);
  kind.reserves = from.reserve > 0;
  kind.avoids = from.avoid;
  if (from.ways || from.forage) kind.wayfaring = crowd::Wayfaring{from.ways.value_or(Ways{}), from.forage};
  kind.threat = from.threat;
  CrowdOptions asked = crowd.options;
  asked.sleep = kind.rests(asked);
  kind.reacts = from.reactions;
  kind.hurts = from.hurt || kind.reacts;
  if (kind.hurts) kind.wholeRecord = crowd::hurtRecord({}, kind.regaitOf({}));
  if (from.adapts) {
    kind.gaitMap = crowd::gaitMapOf(kind.rig, kind.tuning);
    kind.gaitMapBuffer = gpu::Buffer(context, kind.gaitMap.records.size() * sizeof(float), "map of gaits");
    gpu::upload(context, kind.gaitMapBuffer, kind.gaitMap.records);
  }
  const bool amongWalls = kind.avoids && !crowd.scene.obstacles.empty();
  if (amongWalls) kind.wallBuffer = crowd::makeWalls(crowd, kind);
  for (const Stage& stage : crowd::stagesOf(kind.controller, asked,
                                            {.avoids = kind.avoids,
                                            .findsWays = kind.findsWay(),
                                            .forages = kind.forages(),
                                            .amongWalls = amongWalls,
                                            .hurts = kind.hurts,
                                            .reacts = kind.reacts,
                                            .adapts = from.adapts,
                                            .reserves = kind.reserves}))
    kind.stages.push_back({stage});
  return kind;
}

void expectMemory(const gpu::Context& context, uint64_t agents, uint64_t needed) {
  const gpu::FreeMemory available = gpu::availableMemory(context.physical());
  if (needed > available.bytes)
    throw deviceError(std::to_string(agents) + " agents need " + gibibytes(needed) + ", " +
                      context.report().name + " has " + gibibytes(available.bytes) + " available (" +
                      available.of + ")");
}

// Writes the colours of the agents of a kind, where some herd of it has any.
void uploadTints(const Impl& crowd, uint32_t kind) {
  const std::vector<crowd::HerdRun> runs = crowd::runsOf(crowd, kind);
  // Only a colour takes the mean, for which images are decoded.
  const bool takesMean =
      std::ranges::any_of(runs, [](const crowd::HerdRun& of) { return of.herd->from.colour.has_value(); });
  const float lightness = takesMean ? crowd::meanLightness(crowd.kinds[kind]) : 1;
  for (const crowd::HerdRun& of : runs)
    for (const crowd::Part& part : crowd::partsOf(crowd, of.number)) {
      if (part.kind != &crowd.kinds[kind]) continue;
      const std::vector<glm::vec4> tints = crowd::tintsOf(of.herd->from, part, of.herd->seed, lightness);
      gpu::uploadBytes(*crowd.context, part.page->tint, std::as_bytes(std::span(tints)),
                       part.first * sizeof(glm::vec4));
    }
}

// The kind's pipelines, and its agents: where they begin, or zeros.
void fill(Impl& crowd, uint32_t k, bool spawns = true) {
  crowd::Kind& kind = crowd.kinds[k];
  for (crowd::ReadyStage& stage : kind.stages)
    crowd::makeKernels({*crowd.context, crowd.options, kind}, stage);
  crowd::beginWays(crowd, k, spawns);
  crowd::beginTrails(crowd, k);
  std::vector<crowd::Spawner> spawners;
  if (spawns)
    for (const crowd::HerdRun& of : crowd::runsOf(crowd, k))
      spawners.push_back(crowd::spawnerOf(crowd, *of.herd, *of.run));
  kind.pages = crowd::makePages(crowd, kind, spawners);
  crowd::bindTrails(crowd, kind);
  if (kind.tinted) uploadTints(crowd, k);
}

// A crowd without herds, which will have so many places at most.
std::unique_ptr<Impl> beginCrowd(Device& device, const Heightfield& terrain, const Scene& scene,
                                 const CrowdOptions& options, uint64_t places) {
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
  crowd::checkWorld(terrain, scene);
  crowd.threats = scene.threats;
  crowd.terrain = terrain;
  crowd.heights = gpu::Image(
      context, {vk::Format::eR32Sfloat, {terrain.columns, terrain.rows}, vk::ImageUsageFlagBits::eSampled},
      "heights");
  gpu::uploadImage(context, crowd.heights, terrain.heights, gpu::sampledOn(context));
  crowd.edits = crowd::HeightEdits(context);
  crowd.events = scene.events;
  if (!options.levels) crowd.options.levels = scene.levels;
  if (crowd.options.levels) {
    crowd::expectLevelled(crowd.options);
    crowd.rates.emplace(context, *crowd.options.levels);
  }
  if (options.timestamps) crowd.timer = gpu::StageTimer(context, crowd::Frame::mostStages);
  crowd.watchEvery = crowd::watchEvery(options, places);
  return made;
}

// Once herds and kinds have their places: there is memory for their agents.
void expectRoom(Impl& crowd) {
  uint64_t needed = 0, agents = 0;
  for (crowd::Kind& kind : crowd.kinds) {
    if (kind.stages.empty()) continue;
    kind.herdSteps = crowd::herdStepsOf(crowd, kind);
    needed += crowd::bytesOf(crowd, kind);
    agents += kind.agents;
  }
  expectMemory(*crowd.context, agents, needed + crowd::bytesOfGrid(crowd));
  if (agents > Scene::maxAgents)
    throw inputError(std::to_string(agents) + " agents, expected at most " +
                     std::to_string(Scene::maxAgents));
}

// Then the kinds' pipelines and agents.
void fillAll(Impl& crowd, bool spawn) {
  for (uint32_t k = 0; k < crowd.kinds.size(); ++k)
    if (!crowd.kinds[k].stages.empty()) fill(crowd, k, spawn);
  crowd::shareGround(crowd);
}

// A herd of those kinds, one a size; nobody is present yet.
crowd::Herd herdFrom(const Herd& from, uint64_t seed, std::span<const uint32_t> kinds) {
  crowd::Numbering numbering = crowd::numberingOf(from, seed);
  crowd::Herd herd{.runs = {},
                   .agents = from.agents + from.reserve,
                   .starts = std::move(numbering.starts),
                   .from = from,
                   .seed = seed};
  uint32_t first = 0;
  for (size_t i = 0; i < kinds.size(); ++i) {
    herd.runs.push_back({.kind = kinds[i], .firstOfHerd = first, .agents = numbering.counts[i]});
    first += numbering.counts[i];
  }
  return herd;
}

// The run's agents follow those that the kind has.
void enrol(const Impl& crowd, const Herd& from, crowd::SizeRun& run, crowd::Kind& kind) {
  run.place = static_cast<uint32_t>(kind.firstAgents.size());
  run.firstAgent = static_cast<uint32_t>(kind.agents);
  kind.firstAgents.push_back(kind.agents);
  kind.agents += run.agents;
  kind.tinted = kind.tinted || crowd::isTinted(crowd.options, from);
}

// The kinds of a herd by itself, one a size; without its agents.
std::vector<crowd::Kind> kindsFor(const Impl& crowd, const Herd& from, const Rig& loaded) {
  std::vector<crowd::Kind> kinds;
  for (const float size : crowd::sizesOf(from)) kinds.push_back(makeKind(crowd, from, loaded, size));
  return kinds;
}

// Makes the call, whose Error names the event by which a herd comes.
template <class Call>
auto asEvent(const Impl& crowd, size_t event, const Call& call) {
  try {
    return call();
  } catch (const Error& fault) {
    throw Error(fault.kind(),
                fmt::format("{}: events[{}].addHerd: {}", crowd.scene.name, event, fault.what()));
  }
}

// Reads the rigs and clips of the herds that events after a tick will add, so that no file is read while the
// crowd runs.
void prepareComing(Impl& crowd, uint64_t tick, float dt) {
  std::map<std::pair<std::string, Controller>, Rig> rigs;  // the controller decides how a rig is read
  const auto isPast = [&](const Event& event) {
    return tick > 0 && crowd::tickOf(event, double{dt}) <= tick;
  };
  const size_t begun = static_cast<size_t>(std::ranges::count_if(crowd.events, isPast)) + crowd.begun;
  for (size_t e = begun; e < crowd.events.size(); ++e) {
    const Event& event = crowd.events[e];
    const auto* addition = std::get_if<HerdAddition>(&event.what);
    if (addition == nullptr) continue;
    const Herd& herd = addition->herd;
    asEvent(crowd, e, [&] {
      const std::pair key(herd.rig, herd.controller);
      auto loaded = rigs.find(key);
      if (loaded == rigs.end()) loaded = rigs.emplace(key, crowd::rigOf(herd)).first;
      crowd.coming.emplace(e, kindsFor(crowd, herd, loaded->second));
    });
  }
}

void expectLeaders(const Scene& scene, uint32_t h) {
  const auto name = [&] { return fmt::format("{}: herds[{}]", scene.name, h); };
  crowd::expectItsHerds(name, scene.herds[h].goal, scene.herds[h], [&](uint32_t number) -> const Herd& {
    if (number < scene.herds.size()) return scene.herds[number];
    throw inputError(fmt::format("{}.goal.herd is {}, expected less than {}, the number of herds", name(),
                                 number, scene.herds.size()));
  });
}

// The caller's, of a herd that the crowd began with; one that came later has its file's.
Rig restoredRig(const crowd::Herd& herd, uint32_t number, const std::vector<Rig>& rigs) {
  return herd.since == 0 && number < rigs.size() ? rigs[number] : crowd::rigFor(herd.from);
}

// The kind is for those agents alone.
void claim(const Impl& crowd, const Herd& from, crowd::SizeRun& run, crowd::Kind& kind) {
  if (crowd.dt > 0) {
    checkTick(kind, crowd.dt);
    crowd::setParameters(crowd, crowd.dt, kind);
  }
  kind.firstAgents.clear();
  kind.agents = 0;
  enrol(crowd, from, run, kind);
  kind.herdSteps = crowd::herdStepsOf(crowd, kind);
}

// The lowest numbers that no kind has: of those that are gone, and of new ones at the end.
std::vector<uint32_t> freeKinds(const Impl& crowd, size_t count) {
  std::vector<uint32_t> numbers;
  for (uint32_t i = 0; numbers.size() < count; ++i)
    if (i >= crowd.kinds.size() || crowd.kinds[i].stages.empty()) numbers.push_back(i);
  return numbers;
}

// Beyond its end the list grows.
template <class List, class Item>
void put(List& list, uint32_t number, Item item) {
  if (number >= list.size()) list.resize(number + 1);
  list[number] = std::move(item);
}

// A herd of that number, with kinds of its own: those that kindsFor has made, which stay where an Error is
// thrown.
HerdId admit(Impl& crowd, uint32_t number, const Herd& from, std::vector<crowd::Kind>& kinds) {
  const std::vector<uint32_t> slots = freeKinds(crowd, kinds.size());
  const crowd::Herd none;
  const crowd::Herd& before = number < crowd.herds.size() ? crowd.herds[number] : none;
  crowd::Herd herd = herdFrom(from, crowd::seedOf(crowd.seed, number), slots);
  herd.generation = (before.generation + 1) / 2 * 2;
  herd.since = crowd.tick;
  uint64_t needed = 0;
  for (size_t i = 0; i < kinds.size(); ++i) {
    claim(crowd, from, herd.runs[i], kinds[i]);
    needed += crowd::bytesOf(crowd, kinds[i]);
  }
  expectMemory(*crowd.context, herd.agents, needed);
  // `generation`, which is even, is that of places where somebody is.
  herd.presence = crowd::Presence::beginning(from, herd.starts, before.presence.nextGeneration());

  const HerdId id{number, herd.generation};
  for (size_t i = 0; i < slots.size(); ++i) put(crowd.kinds, slots[i], std::move(kinds[i]));
  put(crowd.herds, number, std::move(herd));
  try {
    for (const uint32_t k : slots) fill(crowd, k);
    crowd::shareGround(crowd);
    for (const uint32_t k : slots) {
      settle(crowd, std::span(&crowd.kinds[k], 1));
      gpu::submitAndWait(*crowd.context, [&](vk::CommandBuffer cmd) {
        gpu::allToAll(cmd);
        crowd::beginWatch(crowd, k, cmd);
        gpu::allToAll(cmd);
      });
    }
  } catch (...) {
    for (size_t i = 0; i < slots.size(); ++i) {
      kinds[i] = std::exchange(crowd.kinds[slots[i]], {});
      kinds[i].pages.clear();
    }
    crowd::vacate(crowd, number);
    crowd::shareGround(crowd);
    throw;
  }
  ++crowd.revision;
  return id;
}

}  // namespace

namespace crowd {

std::unique_ptr<Crowd::Impl> makeCrowd(Device& device, const Heightfield& terrain, const Scene& scene,
                                       const Kinds& kinds, const CrowdOptions& options) {
  // A state's were checked when its crowd began, with the herds that there were then.
  for (uint32_t h = 0; h < scene.herds.size(); ++h) expectLeaders(scene, h);
  const uint64_t places = checkEvents(scene, terrain, kinds);
  auto made = beginCrowd(device, terrain, scene, options, places);
  Impl& crowd = *made;
  for (size_t k = 0; k < kinds.rigs.size(); ++k) {
    const SizedHerd& first = kinds.herds[kinds.firstHerds[k]];
    crowd.kinds.push_back(makeKind(crowd, scene.herds[first.herd], kinds.rigs[k], first.size));
  }
  std::vector<std::vector<uint32_t>> ofHerds(scene.herds.size());
  for (const SizedHerd& sized : kinds.herds) ofHerds[sized.herd].push_back(sized.kind);
  for (size_t h = 0; h < scene.herds.size(); ++h) {
    const skitter::Herd& from = scene.herds[h];
    Herd& herd = crowd.herds.emplace_back(herdFrom(from, seedOf(crowd.seed, h), ofHerds[h]));
    for (SizeRun& run : herd.runs) enrol(crowd, from, run, crowd.kinds[run.kind]);
  }
  prepareComing(crowd, 0, 0);
  expectRoom(crowd);
  for (Herd& herd : crowd.herds) herd.presence = Presence::beginning(herd.from, herd.starts, 0);
  fillAll(crowd, true);
  settle(crowd, crowd.kinds);
  return made;
}

Rig rigFor(const skitter::Herd& from) {
  Scene scene;
  scene.name = "a new herd";
  scene.herds = {from};
  return std::move(kindsOf(scene).rigs.front());
}

// Herds and kinds have the numbers that they had, those that are gone among them.
std::unique_ptr<Crowd::Impl> remakeCrowd(Device& device, const State& state) {
  if (!state.source)
    throw inputError("a state that no file or bytes were read for, expected one of loadState()");
  auto made = beginCrowd(device, state.terrain, state.scene, state.options, state.scene.capacity());
  Impl& crowd = *made;
  restoreHerds(crowd, state);
  for (uint32_t k = 0; k < crowd.kinds.size(); ++k) {
    const std::vector<HerdRun> runs = runsOf(crowd, k);
    if (runs.empty()) continue;
    const auto& [h, herd, run] = runs.front();
    const float size = sizesOf(herd->from)[static_cast<size_t>(run - herd->runs.data())];
    Kind kind = makeKind(crowd, herd->from, restoredRig(*herd, h, state.options.rigs), size);
    kind.firstAgents = std::move(crowd.kinds[k].firstAgents);
    kind.agents = crowd.kinds[k].agents;
    kind.series = std::move(crowd.kinds[k].series);
    for (const HerdRun& of : runs) kind.tinted = kind.tinted || isTinted(state.options, of.herd->from);
    crowd.kinds[k] = std::move(kind);
  }
  prepareComing(crowd, state.tick, state.dt);
  checkState(crowd, state);
  expectRoom(crowd);
  fillAll(crowd, false);
  warmUp(crowd, crowd.kinds);
  restore(crowd, state);
  leadEverybody(crowd);
  return made;
}

HerdId makeHerd(Crowd::Impl& crowd, uint32_t number, const skitter::Herd& from, const Rig& rig) {
  std::vector<Kind> kinds = kindsFor(crowd, from, rig);
  return admit(crowd, number, from, kinds);
}

void vacate(Impl& crowd, uint32_t number) {
  Herd& herd = crowd.herds[number];
  herd.runs = {SizeRun{.kind = herd.runs.front().kind}};
  herd.agents = herd.presence.count = 0;
  herd.starts = {};
  herd.from = {};  // its files may go, too
  herd.from.agents = 0;
  ++herd.generation;
  ++crowd.revision;
}

HerdId addComing(Crowd::Impl& crowd, size_t event) {
  const auto found = crowd.coming.find(event);
  assert(found != crowd.coming.end());
  const skitter::Herd& from = std::get<HerdAddition>(crowd.events[event].what).herd;
  const uint32_t number =
      Roster(crowd).add(from, fmt::format("{}: events[{}].addHerd", crowd.scene.name, event));
  const HerdId id = asEvent(crowd, event, [&] { return admit(crowd, number, from, found->second); });
  crowd.coming.erase(found);
  return id;
}

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
  for (const auto& [event, kinds] : crowd.coming)
    for (const Kind& kind : kinds) checkTick(kind, dt);
  crowd.dt = dt;
  for (Kind& kind : crowd.kinds)
    if (!kind.stages.empty()) setParameters(crowd, dt, kind);
}

}  // namespace crowd
}  // namespace skitter

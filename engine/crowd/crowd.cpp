#include "skitter/crowd.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "crowd/events.h"
#include "crowd/frame.h"
#include "crowd/grid.h"
#include "crowd/herd.h"
#include "crowd/kinds.h"
#include "crowd/levels.h"
#include "crowd/page.h"
#include "crowd/readback.h"
#include "crowd/roster.h"
#include "crowd/setup.h"
#include "crowd/steer.h"
#include "crowd/ways/trails.h"
#include "crowd/ways/ways.h"
#include "gpu/barrier.h"
#include "gpu/context.h"
#include "skitter/error.h"

namespace skitter {
Crowd::Crowd(Device& device, const Heightfield& terrain, const Scene& scene, const CrowdOptions& options)
    : impl_(crowd::makeCrowd(
          device, terrain, scene,
          options.rigs.empty() ? crowd::kindsOf(scene) : crowd::kindsOf(scene, options.rigs), options)) {}

Crowd::Crowd(Device& device, const State& state) : impl_(crowd::remakeCrowd(device, state)) {}

Crowd::~Crowd() = default;
Crowd::Crowd(Crowd&&) noexcept = default;
Crowd& Crowd::operator=(Crowd&&) noexcept = default;

void Crowd::record(VkCommandBuffer commandBuffer, float dt) {
  Impl& crowd = *impl_;
  const vk::CommandBuffer cmd(commandBuffer);
  crowd::setTick(crowd, dt);
  crowd::letEventsHappen(*this);
  crowd::keepWays(crowd);
  if (!crowd.edits.empty()) crowd::renewTrails(crowd);
  const uint64_t tick = ++crowd.tick;
  crowd.agentsInTick = agentCount();

  crowd.timer.reset(cmd);
  if (crowd.context->draws()) gpu::graphicsToCompute(cmd);
  gpu::computeToTransfer(cmd);
  crowd::clearLists(crowd.kinds, cmd);
  crowd::clearAwake(crowd, crowd.kinds, cmd);
  if (crowd.rates) crowd.rates->clear(tick, cmd);
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
  if (crowd.grid) {
    crowd.timer.next(cmd, last = "grid");
    crowd.grid->record(crowd, cmd);
    crowd.agentTicks += crowd.agentsInTick;
  }
  const bool inTurns = crowd.rates.has_value();
  if (inTurns) run(wake, counted);
  run(navigate, written);
  if (crowd::forages(crowd)) {
    crowd.timer.next(cmd, last = "trails");
    crowd::recordTrails(crowd, cmd);
  }
  run(avoid, written);
  if (!inTurns) run(wake, counted);
  run(adapt, written);
  run(react, written);
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

HerdId Crowd::addHerd(const Herd& from) {
  Impl& crowd = *impl_;
  const Rig loaded = crowd::rigFor(from);
  crowd::expectItsHerds([] { return "a new herd"; }, from.goal, from,
                        [&](uint32_t leader) -> const Herd& { return crowd.presentHerdAt(leader).from; });
  const uint32_t number = crowd::Roster(crowd).add(from, "a new herd");
  return crowd::makeHerd(crowd, number, from, loaded);
}

void Crowd::removeHerd(HerdId id) {
  Impl& crowd = *impl_;
  if (!has(id))
    throw inputError(fmt::format("herd {} of generation {}: expected one of those that are there", id.index,
                                 id.generation));
  const crowd::Herd& herd = crowd.herds[id.index];
  const auto isAlone = [&](const crowd::SizeRun& run) { return crowd::runsOf(crowd, run.kind).size() == 1; };
  crowd::Roster(crowd).remove(id.index, fmt::format("herd {}", id.index));
  crowd.context->waitIdle();
  for (const crowd::SizeRun& run : herd.runs) {
    if (isAlone(run)) {
      if (crowd.options.sleep && herd.since < crowd.tick) crowd.agentsInTick -= crowd::presentIn(crowd, run);
      crowd.kinds[run.kind] = {};
      continue;
    }
    for (uint32_t agent = run.firstOfHerd; agent < run.firstOfHerd + run.agents; ++agent)
      if (herd.presence.has(agent)) remove(agentId(id.index, agent));
  }
  crowd::vacate(crowd, id.index);
  crowd::shareGround(crowd);
}

bool Crowd::has(HerdId id) const {
  return id.index < impl_->herds.size() && impl_->herds[id.index].generation == id.generation &&
         !impl_->herds[id.index].isGone();
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
const Rig& Crowd::rig(uint32_t herd, uint32_t agent) const { return impl_->kindOf(herd, agent).rig; }
float Crowd::size(uint32_t herd, uint32_t agent) const { return impl_->kindOf(herd, agent).size; }

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
  std::vector<MemoryUse> uses;
  for (const crowd::SizeRun& run : impl_->herdAt(herdIndex).runs) {
    const crowd::Kind& kind = impl_->kinds[run.kind];
    const auto add = [&](const char* name, uint64_t bytes) {
      // What agents before the run's end take, less what those before its beginning do: all shares are the
      // whole.
      const auto upTo = [&](uint64_t agents) { return kind.agents > 0 ? bytes * agents / kind.agents : 0; };
      const uint64_t share = upTo(run.firstAgent + run.agents) - upTo(run.firstAgent);
      const auto same = std::ranges::find(uses, name, &MemoryUse::name);
      if (same == uses.end())
        uses.push_back({name, share});
      else
        same->bytes += share;
    };
    for (const crowd::PageBuffer& each : crowd::pageBuffers(*impl_, kind)) {
      uint64_t bytes = 0;
      for (const crowd::Page& page : kind.pages) bytes += each.in(page).size();
      add(each.name, bytes);
    }
    if (kind.wallBuffer) add("walls", kind.wallBuffer.size());
    if (kind.ways) add("ways", kind.ways->memoryBytes());
    if (kind.trails) add("trails", kind.trails->memoryBytes());
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

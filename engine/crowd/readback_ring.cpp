#include "skitter/readback.h"

#include <fmt/format.h>

#include <algorithm>

#include "crowd/herd.h"
#include "crowd/page.h"
#include "crowd/picking.h"
#include "crowd/radius.h"
#include "gpu/barrier.h"
#include "gpu/buffer.h"
#include "gpu/context.h"
#include "skitter/error.h"

namespace skitter {
namespace {

constexpr size_t bodyFloats = 4 * shared::BODY_STRIDE;

}  // namespace

// Where each herd's bodies are in a slot; a herd that is not read has none.
struct Snapshot::Layout {
  struct Run {
    uint32_t firstAgent, agents;  // of the herd
    crowd::PickSphere sphere;
  };
  struct Herd {
    size_t first = 0;  // floats
    uint32_t agents = 0;
    float radius = 0;  // metres, that holds every pose; 0: not read
    std::vector<Run> runs = {};
  };
  std::vector<Herd> herds;

  std::vector<crowd::PickRun> pickRuns(const Snapshot& snapshot) const {
    std::vector<crowd::PickRun> picks;
    for (uint32_t herd = 0; herd < herds.size(); ++herd)
      for (const Run& run : herds[herd].runs)
        picks.push_back({herd, run.firstAgent,
                         snapshot.bodies(herd).subspan(run.firstAgent * bodyFloats, run.agents * bodyFloats),
                         run.sphere});
    return picks;
  }
};

uint32_t Snapshot::agents(uint32_t herd) const {
  return herd < layout_->herds.size() ? layout_->herds[herd].agents : 0;
}

std::span<const float> Snapshot::bodies(uint32_t herd) const {
  if (agents(herd) == 0) return {};
  return {floats_ + layout_->herds[herd].first, agents(herd) * bodyFloats};
}

BodyState Snapshot::body(uint32_t herd, uint32_t agent, const glm::dvec3& origin) const {
  if (agent >= agents(herd))
    throw inputError(fmt::format("readback: herd {}, agent {}: expected one of the {} that were read", herd,
                                 agent, agents(herd)));
  return bodyOf(bodies(herd).subspan(agent * bodyFloats, bodyFloats), origin);
}

std::optional<Box> Snapshot::bounds(uint32_t herd, const glm::dvec3& origin) const {
  std::optional<Box> box;
  for (uint32_t agent = 0; agent < agents(herd); ++agent) {
    const BodyState there = body(herd, agent, origin);
    if (!there.present) continue;
    if (!box) box = {there.position, there.position};
    box->least = glm::min(box->least, there.position);
    box->most = glm::max(box->most, there.position);
  }
  if (box) {
    const glm::dvec3 around(double{layout_->herds[herd].radius});
    box->least -= around, box->most += around;
  }
  return box;
}

std::optional<Picked> Snapshot::pick(const Ray& ray, const glm::dvec3& origin) const {
  return crowd::pick(layout_->pickRuns(*this), ray, origin);
}

std::optional<Picked> Snapshot::nearest(const glm::dvec3& point, const glm::dvec3& origin) const {
  return crowd::nearest(layout_->pickRuns(*this), point, origin);
}

struct Readback::Impl {
  struct Copy {
    vk::Buffer from;
    vk::BufferCopy region;
  };
  struct Slot {
    gpu::HostBuffer buffer;
    vk::raii::Event made = nullptr;  // set by the device after the copy
    uint64_t tick = 0;               // 0: nothing was recorded into it
    bool isMade() const { return tick > 0 && made.getStatus() == vk::Result::eEventSet; }
  };
  const Crowd::Impl* crowd = nullptr;
  std::vector<HerdId> herds;  // that are read
  Snapshot::Layout layout;
  std::vector<Copy> copies;
  std::vector<Slot> slots;
  uint64_t skipped = 0;

  const Slot* newest() const {
    const Slot* best = nullptr;
    for (const Slot& slot : slots)
      if (slot.isMade() && (best == nullptr || slot.tick > best->tick)) best = &slot;
    return best;
  }
  // One that is not on its way, nor the one that the host may be reading.
  Slot* free() {
    const Slot* kept = newest();
    for (Slot& slot : slots)
      if (slot.tick == 0 || (&slot != kept && slot.isMade())) return &slot;
    return nullptr;
  }
};

Readback::Readback(Device& device, const Crowd& crowd, ReadbackOptions options)
    : impl_(std::make_unique<Impl>()) {
  const gpu::Context& context = device.context();
  const Crowd::Impl& read = implOf(crowd);
  impl_->crowd = &read;
  if (options.slots < 2)
    throw inputError(fmt::format("readback: {} slots, expected at least 2", options.slots));
  if (options.herds.empty())
    for (uint32_t herd = 0; herd < crowd.herdCount(); ++herd)
      if (!read.herds[herd].isGone()) options.herds.push_back(herd);
  impl_->layout.herds.resize(crowd.herdCount());
  uint64_t bytes = 0;
  for (const uint32_t herd : options.herds) {
    const crowd::Herd& from = read.presentHerdAt(herd);
    impl_->herds.push_back(crowd.herdId(herd));
    Snapshot::Layout::Herd& place = impl_->layout.herds[herd];
    if (place.radius > 0) throw inputError(fmt::format("readback: herd {} is named twice", herd));
    place = {bytes / sizeof(float), from.agents, crowd::radiusOf(read, from)};
    for (const crowd::SizeRun& run : from.runs)
      place.runs.push_back({run.firstOfHerd, run.agents, crowd::pickSphereOf(read.kinds[run.kind].rig)});
    for (const RecordBuffer& each : crowd.buffers(herd, Record::body)) {
      impl_->copies.push_back({each.buffer, {each.offset, bytes, each.bytes}});
      bytes += each.bytes;
    }
  }
  impl_->slots.resize(options.slots);
  for (Impl::Slot& slot : impl_->slots) {
    slot.buffer = gpu::HostBuffer(context, bytes, gpu::HostUse::readback, "readback");
    slot.made =
        gpu::guarded("a readback", [&] { return vk::raii::Event(context.device(), vk::EventCreateInfo{}); });
  }
}

Readback::~Readback() = default;
Readback::Readback(Readback&&) noexcept = default;
Readback& Readback::operator=(Readback&&) noexcept = default;

void Readback::record(VkCommandBuffer commandBuffer) {
  for (const HerdId herd : impl_->herds) impl_->crowd->expectHerd("readback", herd);
  Impl::Slot* slot = impl_->free();
  if (slot == nullptr) {
    ++impl_->skipped;
    return;
  }
  const vk::CommandBuffer cmd(commandBuffer);
  slot->made.reset();
  slot->tick = impl_->crowd->tick;
  for (const Impl::Copy& copy : impl_->copies) cmd.copyBuffer(copy.from, slot->buffer.handle(), copy.region);
  gpu::transferToHost(cmd);
  const vk::MemoryBarrier2 after{.srcStageMask = vk::PipelineStageFlagBits2::eAllCommands,
                                 .dstStageMask = vk::PipelineStageFlagBits2::eAllCommands};
  cmd.setEvent2(*slot->made, vk::DependencyInfo{.memoryBarrierCount = 1, .pMemoryBarriers = &after});
}

std::optional<Snapshot> Readback::latest() const {
  const Impl::Slot* slot = impl_->newest();
  if (slot == nullptr) return {};
  return Snapshot(impl_->layout, slot->buffer.as<float>().data(), slot->tick);
}

uint64_t Readback::skipped() const { return impl_->skipped; }

}  // namespace skitter

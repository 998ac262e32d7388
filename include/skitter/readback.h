#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "skitter/crowd.h"
#include "skitter/decode.h"
#include "skitter/device.h"
#include "skitter/export.h"
#include "skitter/picking.h"

namespace skitter {

struct ReadbackOptions {
  // Whose agents are read; none: those of all herds that are there now. Herds that come later read as empty.
  std::vector<uint32_t> herds = {};
  uint32_t slots = 3;  // copies that there is room for, at least 2
};

// World metres, relative to an origin.
struct Box {
  glm::dvec3 least{0}, most{0};
};

class Readback;

// Where agents were after a tick. It looks into the memory of the Readback, until Readback::record() is
// called again. Positions are relative to `origin`. Herds that are not read have no agents.
class SKITTER_API Snapshot {
 public:
  uint64_t tick() const { return tick_; }
  uint32_t agents(uint32_t herd) const;
  std::span<const float> bodies(uint32_t herd) const;  // body records, agent by agent (skitter/records.h)
  // Throws Error(input) for an agent that was not read.
  BodyState body(uint32_t herd, uint32_t agent, const glm::dvec3& origin = glm::dvec3(0)) const;
  // Holds the herd's agents in whatever pose they are; none where there are no agents.
  std::optional<Box> bounds(uint32_t herd, const glm::dvec3& origin = glm::dvec3(0)) const;
  // As Crowd::pick() and Crowd::nearest(), of the agents that were read, without waiting.
  std::optional<Picked> pick(const Ray& ray, const glm::dvec3& origin = glm::dvec3(0)) const;
  std::optional<Picked> nearest(const glm::dvec3& point, const glm::dvec3& origin = glm::dvec3(0)) const;

 private:
  friend Readback;
  struct Layout;
  Snapshot(const Layout& layout, const float* floats, uint64_t tick)
      : layout_(&layout), floats_(floats), tick_(tick) {}
  const Layout* layout_;
  const float* floats_;
  uint64_t tick_;
};

// Reads where agents are while the crowd walks on: a ring of host-visible buffers, into which the device
// copies after a tick. Neither function waits. The result is as many ticks old as the device is behind. A
// VkEvent, set by the copy itself, says that it has been made, so that the caller has no fence or semaphore
// to pass on.
//
// Used by one thread at a time. The crowd outlives it, and what was recorded has
// finished before it goes.
class SKITTER_API Readback {
 public:
  // Throws Error(input) for a herd that is not there, named twice, or less than two slots; Error(device) when
  // memory does not suffice: 64 bytes per place and slot.
  Readback(Device& device, const Crowd& crowd, ReadbackOptions options = {});
  ~Readback();
  Readback(Readback&&) noexcept;
  Readback& operator=(Readback&&) noexcept;

  // Records a copy after Crowd::record() in the same command buffer, outside a render pass. Each must be
  // submitted once, in order. Nothing is recorded, and the tick is counted by skipped(), where every slot is
  // still on its way. Throws Error(input) that names a herd that is read and was removed; then nothing is
  // recorded.
  void record(VkCommandBuffer commandBuffer);
  // The newest that has been made; none before the first.
  std::optional<Snapshot> latest() const;
  uint64_t skipped() const;

 private:
  struct SKITTER_LOCAL Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skitter

#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/buffer.h"

namespace skitter::render {

// Memory of the host that pictures are copied to on the device, one after the other, while later ones are
// drawn.
class PictureRing {
 public:
  PictureRing(const gpu::Context&, uint32_t width, uint32_t height, uint32_t slots);

  uint32_t slots() const { return uint32_t(slots_.size()); }
  // Copies a picture of that size in state TRANSFER_SRC, as Renderer::record leaves it. What was in the slot
  // is no longer needed.
  void record(VkCommandBuffer, VkImage, uint32_t slot) const;
  // Tightly packed RGBA8 rows, top row first, once what recorded them is complete.
  std::span<const uint8_t> pixels(uint32_t slot) const { return slots_[slot].as<uint8_t>(); }

 private:
  uint32_t width_, height_;
  std::vector<gpu::HostBuffer> slots_;
};

}  // namespace skitter::render

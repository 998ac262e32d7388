#pragma once

#include <cstdint>
#include <vector>

#include "gpu/barrier.h"
#include "gpu/buffer.h"
#include "gpu/image.h"
#include "skitter/heightfield.h"

namespace skitter::crowd {

// Edits of the heights that wait for the next tick. Samples travel within the command buffer, so nothing of
// the host needs to outlive the call.
class HeightEdits {
 public:
  // Of the terrain's samples.
  struct Rectangle {
    uint32_t x, z, columns, rows;
  };

  HeightEdits() = default;
  explicit HeightEdits(const gpu::Context& context);

  void add(uint32_t x0, uint32_t z0, uint32_t columns, uint32_t rows) {
    pending_.push_back({x0, z0, columns, rows});
  }
  bool empty() const { return pending_.empty(); }
  const std::vector<Rectangle>& pending() const { return pending_; }
  // Of kMostSamples floats: for whatever else a tick's command buffer carries, too.
  const gpu::Buffer& staging() const { return staging_; }
  // Copies the pending rectangles from `terrain` to the image, which is in state `between` before and after.
  void record(vk::CommandBuffer cmd, const Heightfield& terrain, const gpu::Image& image,
              gpu::ImageState between);

 private:
  std::vector<Rectangle> pending_;
  std::vector<float> packed_;  // rows of a rectangle, close together
  gpu::Buffer staging_;
};

}  // namespace skitter::crowd

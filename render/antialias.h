#pragma once

#include "gpu/graphics.h"

namespace skitter::render {

// Smooths the edges of a picture that was drawn with one sample a pixel.
class Antialias {
 public:
  Antialias() = default;
  // `drawn` is in state sampled when draw() is recorded.
  Antialias(const gpu::Context&, const gpu::Image& drawn, vk::Format colour);
  explicit operator bool() const { return !!pipeline_; }
  void draw(vk::CommandBuffer) const;

 private:
  vk::raii::Sampler sampler_ = nullptr;
  gpu::GraphicsPipeline pipeline_;
  gpu::Bindings bindings_;
};

}  // namespace skitter::render

#pragma once

#include <string>

#include "gpu/graphics.h"

namespace skitter::render {

// Draws an image made of another one: the edge filter, and the enlargement.
class ImagePass {
 public:
  ImagePass() = default;
  // The fragment shader reads `from` as DRAW_DRAWN, which is in state sampled when draw() is recorded.
  ImagePass(const gpu::Context&, const std::string& name, gpu::ShaderCode fragment, const gpu::Image& from,
            vk::Format to);
  void draw(vk::CommandBuffer) const;

 private:
  vk::raii::Sampler sampler_ = nullptr;
  gpu::GraphicsPipeline pipeline_;
  gpu::Bindings bindings_;
};

}  // namespace skitter::render

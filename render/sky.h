#pragma once

#include "render/setting.h"

namespace skitter::render {

// Wherever nothing else was drawn.
class Sky {
 public:
  Sky(const Setting&, bool stars);
  void draw(vk::CommandBuffer) const;

 private:
  gpu::GraphicsPipeline pipeline_;
  gpu::Bindings bindings_;
};

}  // namespace skitter::render

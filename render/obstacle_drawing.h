#pragma once

#include "crowd/herd.h"
#include "render/setting.h"

namespace skitter::render {

// The obstacles of a crowd's scene, which stand on the ground as it is. Nothing where there are none.
class ObstacleDrawing {
 public:
  ObstacleDrawing(const Setting&, const Crowd::Impl&);
  explicit operator bool() const { return indexCount_ > 0; }
  uint64_t triangles() const { return indexCount_ / 3; }

  void drawShadows(vk::CommandBuffer, int cascade) const;
  void draw(vk::CommandBuffer) const;

 private:
  void drawAll(vk::CommandBuffer, const gpu::GraphicsPipeline&, const gpu::Bindings&, int view) const;

  gpu::GraphicsPipeline draw_, shadow_;
  gpu::Bindings drawBindings_, shadowBindings_;
  gpu::Buffer vertices_, indices_;
  uint32_t indexCount_ = 0;
};

}  // namespace skitter::render

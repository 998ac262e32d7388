#pragma once

#include "gpu/graphics.h"
#include "render/picture.h"

namespace skitter::render {

// The sun's shadow map: its cascades are squares beside each other. What casts are the agents and the
// obstacles; the hills' own shadows lie in the ground map, so that the ground needs no bias and feet touch
// their shadows.
class ShadowMap {
 public:
  ShadowMap() = default;
  // `scale`: RendererOptions::scale.
  ShadowMap(const gpu::Context&, uint32_t pictureRows, float scale);

  uint32_t texels() const { return texels_; }  // side of a cascade
  const gpu::Image& image() const { return image_; }
  vk::Sampler sampler() const { return *sampler_; }
  vk::Rect2D square(int cascade) const;

 private:
  uint32_t texels_ = 0;
  gpu::Image image_;
  vk::raii::Sampler sampler_ = nullptr;
};

}  // namespace skitter::render

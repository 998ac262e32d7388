#pragma once

#include "crowd/herd.h"
#include "gpu/graphics.h"
#include "gpu/kernel.h"
#include "render/cull.h"
#include "render/limbs.h"
#include "render/setting.h"

namespace skitter::render {

// Agents that are a few pixels large, drawn by a compute shader (docs/stages/pictures.md, Splats): triangles
// so small cost more than they show.
class Splats {
 public:
  Splats() = default;
  explicit Splats(const Setting&);
  // Not in pictures of more pixels than a binding of the device reaches, 16 million on lavapipe.
  explicit operator bool() const { return bool(draw_); }

  // A kind's shapes and the shader that draws them. It is empty where there are no splats, and where the
  // model has no skin.
  struct Kind {
    gpu::Kernel kernel;
    gpu::Buffer parts;
    float radius = 0;  // about the body's position, metres
    explicit operator bool() const { return bool(kernel); }
  };
  Kind makeKind(const Setting&, const crowd::Kind&, const Limbs&, float radius) const;
  // `tint` is the record of a kind that is tinted, else any.
  gpu::Bindings bind(const Setting&, const Kind&, const gpu::Buffer& body, const gpu::Buffer& pose,
                     const gpu::Buffer& tint, const CulledPage&) const;

  // Before a transferToCompute(): empties what the last picture left.
  void prepare(vk::CommandBuffer) const;
  // After the cull, a computeToIndirectAndCompute() and the shadow map, which is in state sampled, before a
  // computeToGraphics().
  void record(vk::CommandBuffer, const Kind&, const gpu::Bindings&, const CulledPage&,
              const shared::CrowdConstants&) const;
  // All of them, with their depth.
  void draw(vk::CommandBuffer) const;
  // Their shadows, after the ground.
  void drawShades(vk::CommandBuffer) const;

  // The numbers of all pixels and then of their shadows (splat.glsl), and whether each square has any.
  const gpu::Buffer& splats() const { return splats_; }
  const gpu::Buffer& tiles() const { return tiles_; }

 private:
  shared::SplatConstants picture() const;

  vk::Extent2D extent_;
  float splatPixels_ = 0, shadePixels_ = 0;
  gpu::Buffer splats_, tiles_;
  gpu::GraphicsPipeline draw_, shade_;
  gpu::Bindings drawBindings_, shadeBindings_;
};

}  // namespace skitter::render

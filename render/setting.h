#pragma once

#include "gpu/graphics.h"
#include "render/bindings.h"
#include "render/ground_map.h"
#include "render/shadow.h"
#include "skitter/heightfield.h"

namespace skitter::render {

// What every drawing of a picture shares; it outlives them.
struct Setting {
  const gpu::Context& context;
  const Heightfield& terrain;
  const gpu::Image& heights;
  const gpu::Buffer& picture;  // the block shared::Picture
  const gpu::Image& ground;
  vk::Sampler groundSampler;
  const ShadowMap& shadow;
  vk::Format colour, depth;
  vk::SampleCountFlagBits samples;
  vk::Extent2D extent;
  const std::vector<gpu::SpecConstant> light;  // lightConstants of the scene's
  float detail = 1;                            // RendererOptions::detail
  const gpu::Image* occluders = nullptr;  // the picture's depth, where agents that are hidden are left out

  // Constants of whatever is lit (shaders/render/light.glsl).
  std::vector<gpu::SpecConstant> lit() const {
    std::vector<gpu::SpecConstant> constants = light;
    constants.emplace_back(shared::CONSTANT_ROOTS, filtered());
    return constants;
  }
  // Of what lies on the ground and dims it.
  gpu::GraphicsInfo dimming(gpu::GraphicsInfo info) const {
    info.colour = colour;
    info.depth = depth;
    info.samples = samples;
    info.depthUse = gpu::DepthUse::background;
    info.cull = {};
    info.blended = true;
    return info;
  }
  bool filtered() const { return samples == vk::SampleCountFlagBits::e1; }  // edges are smoothed afterwards
};

}  // namespace skitter::render

#include "render/shadow.h"

#include <cmath>

namespace skitter::render {
namespace {

// A taller picture would show the texels of the smaller map. Whole tiles of a software device.
uint32_t texelsFor(uint32_t rows, float scale) {
  constexpr uint32_t tile = 64;
  return uint32_t(std::ceil(scale * float(rows > 1440 ? 4096 : 2048) / tile)) * tile;
}

}  // namespace

ShadowMap::ShadowMap(const gpu::Context& context, uint32_t pictureRows, float scale)
    : texels_(texelsFor(pictureRows, scale)) {
  const vk::Format format = vk::Format::eD16Unorm;
  image_ = gpu::Image(
      context,
      {.format = format,
       .extent = {texels_ * uint32_t(shared::SHADOW_CASCADES), texels_},
       .usage = vk::ImageUsageFlagBits::eDepthStencilAttachment | vk::ImageUsageFlagBits::eSampled},
      "shadow map");
  sampler_ = gpu::makeSampler(
      context,
      {.name = "shadow comparison", .filter = vk::Filter::eNearest, .compare = vk::CompareOp::eLessOrEqual});
}

vk::Rect2D ShadowMap::square(int cascade) const {
  return {.offset = {int32_t(texels_) * cascade, 0}, .extent = {texels_, texels_}};
}

}  // namespace skitter::render

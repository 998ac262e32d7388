#include "render/shadow.h"

namespace skitter::render {
namespace {

constexpr uint32_t kTallest = 1440;  // pixels; a taller picture would show the texels of the smaller map

}  // namespace

ShadowMap::ShadowMap(const gpu::Context& context, uint32_t pictureHeight)
    : texels_(pictureHeight > kTallest ? 4096 : 2048) {
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

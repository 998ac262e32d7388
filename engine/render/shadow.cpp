#include "render/shadow.h"

namespace skitter::render {

ShadowMap::ShadowMap(const gpu::Context& context) : texels_(2048) {
  const vk::Format format = vk::Format::eD32Sfloat;
  image_ = gpu::Image(
      context,
      {.format = format,
       .extent = {texels_ * uint32_t(shared::SHADOW_CASCADES), texels_},
       .usage = vk::ImageUsageFlagBits::eDepthStencilAttachment | vk::ImageUsageFlagBits::eSampled},
      "shadow map");
  sampler_ = gpu::makeSampler(
      context, {.name = "shadow comparison",
                .filter = gpu::filtersLinearly(context, format) ? vk::Filter::eLinear : vk::Filter::eNearest,
                .compare = vk::CompareOp::eLessOrEqual});
}

vk::Rect2D ShadowMap::square(int cascade) const {
  return {.offset = {int32_t(texels_) * cascade, 0}, .extent = {texels_, texels_}};
}

}  // namespace skitter::render

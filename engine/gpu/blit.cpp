#include "gpu/blit.h"

#include <array>

namespace skitter::gpu {
namespace {

std::array<vk::Offset3D, 2> wholeOf(vk::Extent2D extent) {
  return {vk::Offset3D{}, vk::Offset3D{.x = int32_t(extent.width), .y = int32_t(extent.height), .z = 1}};
}

}  // namespace

void blit(vk::CommandBuffer cmd, const Surface& from, const Surface& to) {
  const vk::ImageSubresourceLayers colour{.aspectMask = vk::ImageAspectFlagBits::eColor, .layerCount = 1};
  const vk::ImageBlit2 region{.srcSubresource = colour,
                              .srcOffsets = wholeOf(from.extent),
                              .dstSubresource = colour,
                              .dstOffsets = wholeOf(to.extent)};
  cmd.blitImage2(vk::BlitImageInfo2{.srcImage = from.image,
                                    .srcImageLayout = layoutOf(ImageState::transferSrc),
                                    .dstImage = to.image,
                                    .dstImageLayout = layoutOf(ImageState::transferDst),
                                    .regionCount = 1,
                                    .pRegions = &region,
                                    .filter = vk::Filter::eLinear});
}

}  // namespace skitter::gpu

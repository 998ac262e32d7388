#include "render/picture_ring.h"

#include "gpu/barrier.h"

namespace skitter::render {

PictureRing::PictureRing(const gpu::Context& context, uint32_t width, uint32_t height, uint32_t slots)
    : width_(width), height_(height) {
  for (uint32_t slot = 0; slot < slots; ++slot)
    slots_.emplace_back(context, uint64_t(width) * height * 4, gpu::HostUse::readback, "picture readback");
}

void PictureRing::record(VkCommandBuffer commandBuffer, VkImage picture, uint32_t slot) const {
  const vk::CommandBuffer cmd(commandBuffer);
  cmd.copyImageToBuffer(picture, gpu::layoutOf(gpu::ImageState::transferSrc), slots_[slot].handle(),
                        vk::BufferImageCopy{.imageSubresource = {vk::ImageAspectFlagBits::eColor, 0, 0, 1},
                                            .imageExtent = {width_, height_, 1}});
  gpu::transferToHost(cmd);
}

}  // namespace skitter::render

#pragma once

#include "gpu/barrier.h"

namespace skitter::gpu {

// A copy of a whole colour image of its own size into another, whose pixels are interpolated linearly. `from`
// is in state transferSrc, `to` in transferDst.
struct Surface {
  vk::Image image;
  vk::Extent2D extent;
};
void blit(vk::CommandBuffer, const Surface& from, const Surface& to);

}  // namespace skitter::gpu

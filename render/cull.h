#pragma once

#include "gpu/kernel.h"
#include "render/picture.h"

namespace skitter::render {

// What the list of splats has where the others have a draw.
struct SplatDispatch {
  uint32_t unused = 0;
  uint32_t agents = 0;                        // as many as a draw has instances
  VkDispatchIndirectCommand groups{0, 1, 1};  // of splat.comp
};
static_assert(sizeof(SplatDispatch) == sizeof(VkDrawIndexedIndirectCommand));

// A page's instance lists and their indirect draws, chosen on the device.
struct CulledPage {
  uint32_t agents = 0;
  gpu::Buffer instances;  // uint32: list after list of `agents` entries each
  gpu::Buffer commands;   // a VkDrawIndexedIndirectCommand a list
  gpu::Bindings bindings;
};

class Cull {
 public:
  Cull() = default;
  // `detail`: RendererOptions::detail.
  Cull(const gpu::Context&, float detail);

  CulledPage makePage(const gpu::Context&, const gpu::Buffer& picture, const gpu::Buffer& bodies,
                      uint32_t agents) const;
  // `splats`: whether small agents may be drawn as such; `fades`: whether they go over to them by and by.
  void record(vk::CommandBuffer, const CulledPage&, float radius, bool splats, bool fades) const;

 private:
  gpu::Kernel kernel_;
  float detail_ = 1;
};

}  // namespace skitter::render

#pragma once

#include <cstddef>

#include "gpu/kernel.h"
#include "render/picture.h"

namespace skitter::render {

// Shaders go through the lists SPLATS and SHOWN, which have this where the others have a draw.
struct ListDispatch {
  uint32_t unused = 0;
  uint32_t agents = 0;  // as many as a draw has instances
  VkDispatchIndirectCommand groups{0, 1, 1};
};
static_assert(sizeof(ListDispatch) == sizeof(VkDrawIndexedIndirectCommand));
// Where the groups of such a list are among the commands of a page, bytes.
constexpr uint64_t groupsOffset(int list) {
  return uint64_t(list) * sizeof(ListDispatch) + offsetof(ListDispatch, groups);
}

// A page's instance lists and their indirect draws, chosen on the device.
struct CulledPage {
  uint32_t agents = 0;
  bool listsShown = false;  // whether the list SHOWN is filled
  gpu::Buffer instances;    // uint32: list after list of `agents` entries each
  gpu::Buffer commands;     // a VkDrawIndexedIndirectCommand a list
  gpu::Bindings bindings;
};

class Cull {
 public:
  Cull() = default;
  // `detail`: RendererOptions::detail.
  Cull(const gpu::Context&, float detail);

  // `listsShown`: whether the list SHOWN is filled. `looks`: whether there are those of occlusion.
  CulledPage makePage(const gpu::Context&, const gpu::Buffer& picture, const gpu::Buffer& bodies,
                      uint32_t agents, bool listsShown = false, bool looks = false) const;
  // `splats`: whether small agents may be drawn as such.
  void record(vk::CommandBuffer, const CulledPage&, float radius, bool splats) const;

 private:
  gpu::Kernel kernel_;
  float detail_ = 1;
};

}  // namespace skitter::render

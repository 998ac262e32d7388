#pragma once

#include "crowd/herd.h"
#include "render/cull.h"
#include "render/mesh.h"
#include "render/setting.h"

namespace skitter::render {

// Leaves agents out that others or the ground hide (docs/stages/pictures.md, Occlusion). A picture begins
// with whom the last one showed; their depth and the ground's then decide whom else it shows.
class Occlusion {
 public:
  Occlusion() = default;
  // None where the setting has no depth to look at.
  explicit Occlusion(const Setting&);
  explicit operator bool() const { return bool(first_); }

  // Where the agents of a kind may be seen, and the kernel that looks there. Empty for a model without skin.
  struct Kind {
    gpu::Kernel second;
    gpu::Buffer boxes;
    uint32_t boxCount = 0, palette = 0;
  };
  Kind makeKind(const Setting&, const crowd::Kind&, const MeshData&, uint32_t palette) const;

  struct Page {
    gpu::Buffer seen;
    gpu::Bindings first, second;
  };
  // `body` and `pose` are those that are drawn.
  Page makePage(const Setting&, const Kind&, const gpu::Buffer& body, const gpu::Buffer& pose,
                const CulledPage&) const;

  // Fills the lists FIRST_LOOK; after the cull and a computeToCompute().
  void lookFirst(vk::CommandBuffer, const CulledPage&, const Page&) const;
  // From the depth of what has been drawn, in state sampled; ends with a computeToCompute().
  void makePyramid(vk::CommandBuffer) const;
  // Fills the lists LATER, with whom those that have been drawn do not hide.
  void lookAgain(vk::CommandBuffer, const Kind&, const CulledPage&, const Page&) const;

 private:
  shared::OcclusionConstants constantsOf(const CulledPage&) const;

  vk::Extent2D extent_;
  gpu::Kernel first_, pyramid_;
  gpu::Buffer squares_;
  gpu::Bindings pyramidBindings_;
};

}  // namespace skitter::render

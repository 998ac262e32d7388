#pragma once

#include "gpu/kernel.h"
#include "render/cull.h"
#include "render/picture.h"

namespace skitter::render {

// Moves agents on in every picture that do not tick in every tick of the crowd (docs/levels.md, Pictures):
// from how the last picture showed an agent to how its last tick left it.
class Interpolation {
 public:
  Interpolation() = default;
  explicit Interpolation(const gpu::Context&);
  explicit operator bool() const { return bool(bodies_); }

  // The records of a page as pictures show them.
  struct Page {
    gpu::Buffer body, pose;  // InterpolationConstants says what is in them
    gpu::Kernel kernel;      // of its poses
    gpu::Bindings bodies, poses;
  };
  // The crowd's own records of a page, and whether its poses are matrices, as those of clips. Without poses
  // bodies alone are moved on.
  struct Source {
    const gpu::Buffer &body, &pose, &rate;
    bool matrices = false;
  };
  Page makePage(const gpu::Context&, const Source&) const;
  // The lists are the page's own, which the cull makes of the shown bodies.
  void bindLists(const gpu::Context&, const Source&, const CulledPage&, Page&) const;

  // Before the cull and a computeToCompute().
  void recordBodies(vk::CommandBuffer, const Page&, const shared::InterpolationConstants&) const;
  // After the cull and a computeToIndirectAndCompute(), before poses are read.
  void recordPoses(vk::CommandBuffer, const Page&, const CulledPage&,
                   const shared::InterpolationConstants&) const;

 private:
  gpu::Kernel bodies_;
};

}  // namespace skitter::render

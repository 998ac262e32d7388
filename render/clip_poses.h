#pragma once

#include "crowd/herd.h"
#include "gpu/kernel.h"
#include "render/cull.h"
#include "render/picture.h"

namespace skitter::render {

// Poses agents that only play clips where a picture shows them. So a crowd of such agents that is drawn needs
// no poses of its own (CrowdOptions::pose).
class ClipPoses {
 public:
  ClipPoses() = default;
  // The kind's controller is clip. `atRates`: whether blocks tick at rates of their own.
  ClipPoses(const gpu::Context&, const crowd::Kind&, bool atRates);
  explicit operator bool() const { return bool(kernel_); }

  gpu::Buffer makePoses(const gpu::Context&, uint32_t agents) const;
  // `shownBody` is Interpolation::Page::body where there are rates, else any.
  gpu::Bindings bind(const gpu::Context&, const crowd::Kind&, const crowd::Page&,
                     const gpu::Buffer& shownBody, const CulledPage&, const gpu::Buffer& poses) const;
  // After the cull and a computeToIndirectAndCompute(), before poses are read.
  void record(vk::CommandBuffer, const gpu::Bindings&, const crowd::Kind&, const CulledPage&,
              uint64_t tick) const;

 private:
  gpu::Kernel kernel_;
  bool atRates_ = false;
  int joints_ = 0;
};

}  // namespace skitter::render

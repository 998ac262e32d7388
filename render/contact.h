#pragma once

#include "crowd/herd.h"
#include "render/cull.h"
#include "render/limbs.h"
#include "render/setting.h"

namespace skitter::render {

// How ground below feet and bodies darkens (docs/stages/pictures.md, Contact): squares on the ground, of
// agents that are near.
class Contact {
 public:
  Contact() = default;
  Contact(const Setting&, const crowd::Kind&, const Limbs&);

  struct Page {
    gpu::Buffer draw;  // indirect
    gpu::Bindings bindings;
  };
  Page makePage(const Setting&, const gpu::Buffer& body, const gpu::Buffer& pose) const;
  explicit operator bool() const { return indexCount_ > 0; }

  // Between computeToTransfer() and transferToGraphics().
  void count(vk::CommandBuffer, const Page&, const CulledPage&) const;
  // After the ground.
  void draw(vk::CommandBuffer, const Page&, const CulledPage&, uint32_t palette) const;

 private:
  gpu::GraphicsPipeline pipeline_;
  gpu::Buffer vertices_, indices_;
  uint32_t indexCount_ = 0;
};

}  // namespace skitter::render

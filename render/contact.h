#pragma once

#include "crowd/herd.h"
#include "render/cull.h"
#include "render/setting.h"

namespace skitter::render {

// How ground below feet and bodies darkens (docs/stages/pictures.md, Contact): squares on the ground, of the
// agents of the first lists alone, that are near.
class Contact {
 public:
  static constexpr int lists = 2;  // the camera's two finest levels of detail

  Contact() = default;
  // Draws nothing of a kind that plays clips, whose models have no legs.
  Contact(const Setting&, const crowd::Kind&);

  struct Page {
    gpu::Buffer draws;  // indirect, of each list
    gpu::Bindings bindings;
  };
  Page makePage(const Setting&, const crowd::Page&) const;
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

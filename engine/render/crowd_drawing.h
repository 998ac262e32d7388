#pragma once

#include "crowd/herd.h"
#include "render/cull.h"
#include "render/mesh.h"
#include "render/setting.h"

namespace skitter::render {

// The forms of a kind's shaders.
struct CrowdForms {
  bool matrices = false;  // poses are matrices instead of rotations
  bool tinted = false;    // agents have tints
  bool stumps = false;    // bones may be lost
};
// The pipeline that shades a kind, without its targets. `influences` is the most bones that carry a vertex.
gpu::GraphicsInfo crowdShading(int influences, const CrowdForms& forms);

// The crowd, skinned where its poses lie: one indirect draw a page and level of detail.
class CrowdDrawing {
 public:
  CrowdDrawing(const Setting&, const Crowd::Impl&);

  // Outside rendering, before a transferToCompute(): empties the lists.
  void prepare(vk::CommandBuffer) const;
  // Fills them; before a computeToGraphics().
  void cull(vk::CommandBuffer) const;
  void drawShadows(vk::CommandBuffer, int cascade) const;
  void draw(vk::CommandBuffer) const;

 private:
  struct Page {
    uint32_t firstAgent = 0;
    CulledPage culled;
    gpu::Bindings draw, shadow;
  };
  struct Kind {
    uint32_t palette = 0;
    Mesh mesh;
    gpu::GraphicsPipeline draw, shadow;
    std::vector<Page> pages;
  };
  void drawList(vk::CommandBuffer, const Kind&, const Page&, int list) const;

  Cull cull_;
  std::vector<Kind> kinds_;
};

}  // namespace skitter::render

#pragma once

#include <array>
#include <optional>
#include <span>

#include "crowd/herd.h"
#include "render/clip_poses.h"
#include "render/contact.h"
#include "render/cull.h"
#include "render/interpolation.h"
#include "render/mesh.h"
#include "render/occlusion.h"
#include "render/setting.h"
#include "render/splats.h"
#include "render/textures.h"
#include "skitter/renderer.h"

namespace skitter::render {

// The forms of a kind's shaders.
struct CrowdForms {
  bool matrices = false;  // poses are matrices instead of rotations
  bool tinted = false;    // agents have tints
  bool stumps = false;    // bones may be lost
};
// The pipeline that shades a kind, without its targets. `influences` is the most bones that carry a vertex.
gpu::GraphicsInfo crowdShading(int influences, const CrowdForms& forms);
// The same of its levels that are lit at their vertices.
gpu::GraphicsInfo litShading(int influences, const CrowdForms& forms);
// The same of what a kind wears of a material that has the textures `has` (Textures::has).
gpu::GraphicsInfo wornShading(int influences, const CrowdForms& forms, const Material&, int has);

// The crowd, skinned where its poses lie: one indirect draw a page and level of detail.
class CrowdDrawing {
 public:
  // The store outlives the drawing.
  CrowdDrawing(const Setting&, const Crowd::Impl&, TextureStore&);

  // Outside rendering, before a transferToCompute(): empties the lists.
  void prepare(vk::CommandBuffer) const;
  // Fills them, and poses who is on them.
  void cull(vk::CommandBuffer, const Crowd::Impl&);
  // Draws small agents; after the shadow map, before a computeToGraphics().
  void splat(vk::CommandBuffer) const;
  // Gives each part of a kind with materials, and contacts, their counts of agents; after the cull and a
  // computeToGraphics().
  void countParts(vk::CommandBuffer) const;
  void drawShadows(vk::CommandBuffer, int cascade) const;
  // Everybody in sight, or with occlusion whom the last picture showed.
  void draw(vk::CommandBuffer) const;
  // With occlusion, outside rendering and after the ground: finds whom the picture's depth, in state sampled,
  // does not hide.
  void lookAgain(vk::CommandBuffer) const;
  // And draws who had not been drawn.
  void drawLater(vk::CommandBuffer) const;
  // With the shadows of splats, after the ground, which they darken.
  void drawContacts(vk::CommandBuffer) const;
  // Whether there is anybody who could be drawn.
  bool hasAgents() const;
  // Of the last picture, from the device, which has drawn it.
  PictureCounts counts(const gpu::Context&) const;

 private:
  // How meshes are drawn: in the camera's sight and in shadow maps, each also for what goes over to splats.
  enum Pass { kDraw, kFading, kShadow, kFadingShadow, kPasses };
  template <class T>
  using ByPass = std::array<T, kPasses>;
  struct Page {
    uint32_t firstAgent = 0;
    Interpolation::Page shown;  // where agents have rates of their own
    CulledPage culled;
    gpu::Buffer clipPoses;  // where the crowd has none
    gpu::Bindings posesClips;
    ByPass<gpu::Bindings> passes;
    gpu::Bindings lit, splat;
    Occlusion::Page occlusion;
    Contact::Page contact;
    // For a kind with materials: the indirect draws of each list, part by part, and the bindings of each
    // part's pipelines.
    gpu::Buffer partDraws;
    std::vector<ByPass<gpu::Bindings>> parts;
  };
  // Pipelines of materials that differ in numbers and images alone; none where the kind's own serve.
  struct Worn {
    int textures = 0;  // Textures::has
    bool cutout = false, doubleSided = false;
    ByPass<gpu::GraphicsPipeline> passes;
  };
  // How a part of a mesh is drawn: by one of `Kind::worn`, or, where it is none (-1), by the kind's own.
  struct Part {
    int worn = -1;
  };
  struct Kind {
    uint32_t palette = 0;
    Mesh mesh;
    ByPass<gpu::GraphicsPipeline> passes;
    gpu::GraphicsPipeline lit;
    Contact contact;
    Splats::Kind splat;
    Occlusion::Kind occlusion;
    ClipPoses clipPoses;      // none where the crowd has poses
    std::vector<Part> parts;  // as the mesh's
    std::vector<Worn> worn;
    std::vector<Page> pages;
  };
  void makeParts(const Setting&, const crowd::Kind&, const Textures&, Kind&) const;
  // The pipeline of a part's material; null where the kind's own serves.
  static const gpu::GraphicsPipeline* wornOf(const Kind&, size_t part, Pass);
  void bindParts(const Setting&, const Textures&, const ByPass<std::vector<gpu::Binding>>&, const Kind&,
                 Page&) const;
  void drawList(vk::CommandBuffer, const Kind&, const Page&, int list) const;
  void drawListPart(vk::CommandBuffer, const Kind&, const Page&, int list, size_t part) const;
  void drawPass(vk::CommandBuffer, const Kind&, const Page&, Pass, std::span<const int> lists,
                const shared::CrowdConstants&) const;
  void bindBuffers(vk::CommandBuffer, const Kind&, const Page&, int list) const;
  // Draws the lists of the camera's levels, the first of which is given, and the one of who fades.
  void drawCamera(vk::CommandBuffer, int firstLevel, int fading) const;
  void countParts(vk::CommandBuffer, std::span<const int> lists, bool contacts) const;

  std::span<const int> meshLists() const;  // that are drawn
  bool hasSplats() const;
  shared::CrowdConstants constantsOf(uint32_t kind, const Page&, int view) const;

  Interpolation interpolation_;     // none where all agents tick in every tick
  std::optional<uint64_t> before_;  // the last picture's tick
  Cull cull_;
  Occlusion occlusion_;  // none without the option
  Splats splats_;
  std::vector<Kind> kinds_;
};

}  // namespace skitter::render

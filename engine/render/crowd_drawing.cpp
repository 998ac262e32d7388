#include "render/crowd_drawing.h"

#include <cstddef>

#include "crowd/controller.h"
#include "embedded/crowd_frag.h"
#include "embedded/crowd_vert_storage.h"
#include "embedded/crowd_vert_texel.h"
#include "embedded/shadow_vert_storage.h"
#include "embedded/shadow_vert_texel.h"
#include "render/bindings.h"
#include "skitter/error.h"

namespace skitter::render {
namespace {

// Each cascade's level of detail: a shadow's outline forgives much.
constexpr int kShadowLod[shared::SHADOW_CASCADES] = {1, 3};

using gpu::BindingKind;

std::vector<gpu::VertexStream> streams(bool shaded) {
  using F = vk::Format;
  const auto influence = [](uint32_t i) {
    return uint32_t(offsetof(MeshVertex, influences) + i * sizeof(glm::vec4));
  };
  gpu::VertexStream vertices{.stride = sizeof(MeshVertex),
                             .rate = vk::VertexInputRate::eVertex,
                             .attributes = {{1, F::eR16G16B16A16Uint, offsetof(MeshVertex, bones)}}};
  for (uint32_t i = 0; i < 4; ++i)
    vertices.attributes.push_back({2 + i, F::eR32G32B32A32Sfloat, influence(i)});
  vertices.attributes.push_back({6, F::eR32G32B32Sfloat, offsetof(MeshVertex, normal)});
  vertices.attributes.push_back({7, F::eR32Sfloat, offsetof(MeshVertex, halfWidth)});
  if (shaded) vertices.attributes.push_back({8, F::eR32G32B32Sfloat, offsetof(MeshVertex, colour)});
  return {vertices,
          {.stride = sizeof(uint32_t),
           .rate = vk::VertexInputRate::eInstance,
           .attributes = {{0, F::eR32Uint, 0}}}};
}

gpu::GraphicsPipeline drawPipeline(const Setting& s, int influences, const CrowdForms& forms) {
  gpu::GraphicsInfo info = crowdShading(influences, forms);
  info.colour = s.colour;
  info.depth = s.depth;
  info.samples = s.samples;
  info.constants.push_back({shared::CONSTANT_ROOTS, s.filtered()});
  return {s.context, info};
}

// Both faces cast: a closed skin loses nothing by it, an open one keeps its shadow.
gpu::GraphicsPipeline shadowPipeline(const Setting& s, int influences, const CrowdForms& forms) {
  return {s.context,
          {.name = "crowd shadow",
           .vertex = {embedded::shadow_vert_texel(), embedded::shadow_vert_storage()},
           .fragment = {},
           .bindings = {{shared::DRAW_PICTURE, BindingKind::uniform},
                        {shared::DRAW_BODY, BindingKind::load4},
                        {shared::DRAW_POSE, BindingKind::load4}},
           .pushBytes = sizeof(shared::CrowdConstants),
           .streams = streams(false),
           .depth = s.shadow.image().format(),
           .depthUse = gpu::DepthUse::shadow,
           .cull = {},
           .constants = {{shared::CONSTANT_INFLUENCES, influences},
                         {shared::CONSTANT_MATRICES, forms.matrices},
                         {shared::CONSTANT_STUMPS, forms.stumps}}}};
}

}  // namespace

gpu::GraphicsInfo crowdShading(int influences, const CrowdForms& forms) {
  return {.name = "crowd",
          .vertex = {embedded::crowd_vert_texel(), embedded::crowd_vert_storage()},
          .fragment = embedded::crowd_frag(),
          .bindings = {{shared::DRAW_PICTURE, BindingKind::uniform},
                       {shared::DRAW_BODY, BindingKind::load4},
                       {shared::DRAW_POSE, BindingKind::load4},
                       {shared::DRAW_TINT, BindingKind::load4},
                       {shared::DRAW_GROUND, BindingKind::texture},
                       {shared::DRAW_SHADOW, BindingKind::texture}},
          .pushBytes = sizeof(shared::CrowdConstants),
          .streams = streams(true),
          .constants = {{shared::CONSTANT_INFLUENCES, influences},
                        {shared::CONSTANT_MATRICES, forms.matrices},
                        {shared::CONSTANT_TINTED, forms.tinted},
                        {shared::CONSTANT_STUMPS, forms.stumps}}};
}

CrowdDrawing::CrowdDrawing(const Setting& s, const Crowd::Impl& crowd) : cull_(s.context) {
  if (!crowd.options.pose) throw inputError("a crowd that is drawn needs CrowdOptions::pose");
  for (const crowd::Kind& source : crowd.kinds) {
    Kind kind;
    if (source.pages.empty()) {  // of a herd that is gone; kinds keep their numbers
      kinds_.push_back(std::move(kind));
      continue;
    }
    const bool clips = crowd::traitsOf(source.controller).playsClips;
    kind.palette = uint32_t(clips ? source.clips.joints : source.rig.paletteSize());
    kind.mesh =
        uploadMesh(s.context, clips ? makeMesh(source.clipSet) : makeMesh(source.rig), source.rig.name);
    const CrowdForms forms{.matrices = clips, .tinted = source.tinted, .stumps = source.hurts};
    kind.draw = drawPipeline(s, kind.mesh.influences, forms);
    kind.shadow = shadowPipeline(s, kind.mesh.influences, forms);
    for (const crowd::Page& records : source.pages) {
      if (records.agents == 0) continue;
      Page page;
      page.firstAgent = records.firstAgent;
      page.culled = cull_.makePage(s.context, s.picture, records.body, records.agents);
      std::vector<gpu::Binding> list{{shared::DRAW_PICTURE, &s.picture},
                                     {shared::DRAW_BODY, &records.body},
                                     {shared::DRAW_POSE, &records.pose}};
      page.shadow = kind.shadow.bind(s.context, list);
      list.push_back({shared::DRAW_TINT, source.tinted ? &records.tint : &records.body});
      list.push_back({shared::DRAW_GROUND, &s.ground, s.groundSampler});
      list.push_back({shared::DRAW_SHADOW, &s.shadow.image(), s.shadow.sampler()});
      page.draw = kind.draw.bind(s.context, list);
      kind.pages.push_back(std::move(page));
    }
    kinds_.push_back(std::move(kind));
  }
}

void CrowdDrawing::prepare(vk::CommandBuffer cmd) const {
  for (const Kind& kind : kinds_)
    for (const Page& page : kind.pages) {
      VkDrawIndexedIndirectCommand draws[shared::INSTANCE_LISTS];
      for (int list = 0; list < shared::INSTANCE_LISTS; ++list) {
        const bool camera = list < shared::CAMERA_LODS;
        const MeshLod& lod = kind.mesh.lods[size_t(camera ? list : kShadowLod[list - shared::CAMERA_LODS])];
        draws[list] = {.indexCount = lod.indexCount,
                       .instanceCount = 0,
                       .firstIndex = lod.firstIndex,
                       .vertexOffset = lod.firstVertex,
                       .firstInstance = 0};
      }
      cmd.updateBuffer(page.culled.commands.handle(), 0, sizeof draws, draws);
    }
}

void CrowdDrawing::cull(vk::CommandBuffer cmd) const {
  for (const Kind& kind : kinds_)
    for (const Page& page : kind.pages) cull_.record(cmd, page.culled, kind.mesh.radius);
}

void CrowdDrawing::drawShadows(vk::CommandBuffer cmd, int cascade) const {
  for (uint32_t k = 0; k < kinds_.size(); ++k)
    for (const Page& page : kinds_[k].pages) {
      const shared::CrowdConstants constants{.view = uint32_t(shared::VIEW_CAMERA + 1 + cascade),
                                             .palette = kinds_[k].palette,
                                             .firstAgent = page.firstAgent,
                                             .kind = k};
      kinds_[k].shadow.use(cmd, page.shadow, gpu::bytesOf(constants));
      drawList(cmd, kinds_[k], page, shared::CAMERA_LODS + cascade);
    }
}

void CrowdDrawing::draw(vk::CommandBuffer cmd) const {
  for (uint32_t k = 0; k < kinds_.size(); ++k)
    for (const Page& page : kinds_[k].pages) {
      const shared::CrowdConstants constants{.view = shared::VIEW_CAMERA,
                                             .palette = kinds_[k].palette,
                                             .firstAgent = page.firstAgent,
                                             .kind = k};
      kinds_[k].draw.use(cmd, page.draw, gpu::bytesOf(constants));
      for (int lod = 0; lod < shared::CAMERA_LODS; ++lod) drawList(cmd, kinds_[k], page, lod);
    }
}

void CrowdDrawing::drawList(vk::CommandBuffer cmd, const Kind& kind, const Page& page, int list) const {
  // The list's place comes by the vertex buffer's offset: firstInstance in an indirect draw is optional in
  // Vulkan.
  const vk::DeviceSize place = vk::DeviceSize(list) * page.culled.agents * sizeof(uint32_t);
  const std::array buffers{kind.mesh.vertices.handle(), page.culled.instances.handle()};
  const std::array<vk::DeviceSize, 2> offsets{0, place};
  cmd.bindVertexBuffers(0, buffers, offsets);
  cmd.bindIndexBuffer(kind.mesh.indices.handle(), 0, vk::IndexType::eUint32);
  cmd.drawIndexedIndirect(page.culled.commands.handle(),
                          vk::DeviceSize(list) * sizeof(VkDrawIndexedIndirectCommand), 1,
                          sizeof(VkDrawIndexedIndirectCommand));
}

}  // namespace skitter::render

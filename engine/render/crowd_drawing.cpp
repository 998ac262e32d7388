#include "render/crowd_drawing.h"

#include <cstddef>

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
  if (shaded) {
    vertices.attributes.push_back({6, F::eR32G32B32Sfloat, offsetof(MeshVertex, normal)});
    vertices.attributes.push_back({7, F::eR32G32B32Sfloat, offsetof(MeshVertex, colour)});
  }
  return {vertices,
          {.stride = sizeof(uint32_t),
           .rate = vk::VertexInputRate::eInstance,
           .attributes = {{0, F::eR32Uint, 0}}}};
}

gpu::GraphicsPipeline drawPipeline(const Setting& s, int influences, bool matrices) {
  return {s.context,
          {.name = "crowd",
           .vertex = {embedded::crowd_vert_texel(), embedded::crowd_vert_storage()},
           .fragment = embedded::crowd_frag(),
           .bindings = {{shared::DRAW_PICTURE, BindingKind::uniform},
                        {shared::DRAW_BODY, BindingKind::load4},
                        {shared::DRAW_POSE, BindingKind::load4},
                        {shared::DRAW_GROUND, BindingKind::texture},
                        {shared::DRAW_SHADOW, BindingKind::texture}},
           .pushBytes = sizeof(shared::CrowdConstants),
           .streams = streams(true),
           .colour = s.colour,
           .depth = s.depth,
           .samples = s.samples,
           .constants = {{shared::CONSTANT_INFLUENCES, influences}, {shared::CONSTANT_MATRICES, matrices}}}};
}

// Both faces cast: a closed skin loses nothing by it, an open one keeps its shadow.
gpu::GraphicsPipeline shadowPipeline(const Setting& s, int influences, bool matrices) {
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
           .constants = {{shared::CONSTANT_INFLUENCES, influences}, {shared::CONSTANT_MATRICES, matrices}}}};
}

}  // namespace

CrowdDrawing::CrowdDrawing(const Setting& s, const Crowd::Impl& crowd) : cull_(s.context) {
  if (!crowd.options.pose) throw inputError("a crowd that is drawn needs CrowdOptions::pose");
  for (const crowd::Herd& source : crowd.herds) {
    Herd herd;
    const bool clips = crowd::playsClips(source.controller);
    herd.palette = uint32_t(clips ? source.clips.joints : source.rig.paletteSize());
    herd.mesh =
        uploadMesh(s.context, clips ? makeMesh(source.clipSet) : makeMesh(source.rig), source.rig.name);
    herd.draw = drawPipeline(s, herd.mesh.influences, clips);
    herd.shadow = shadowPipeline(s, herd.mesh.influences, clips);
    for (const crowd::Page& records : source.pages) {
      if (records.agents == 0) continue;
      Page page;
      page.firstAgent = records.firstAgent;
      page.culled = cull_.makePage(s.context, s.picture, records.body, records.agents);
      std::vector<gpu::Binding> list{{shared::DRAW_PICTURE, &s.picture},
                                     {shared::DRAW_BODY, &records.body},
                                     {shared::DRAW_POSE, &records.pose}};
      page.shadow = herd.shadow.bind(s.context, list);
      list.push_back({shared::DRAW_GROUND, &s.ground, s.groundSampler});
      list.push_back({shared::DRAW_SHADOW, &s.shadow.image(), s.shadow.sampler()});
      page.draw = herd.draw.bind(s.context, list);
      herd.pages.push_back(std::move(page));
    }
    herds_.push_back(std::move(herd));
  }
}

void CrowdDrawing::prepare(vk::CommandBuffer cmd) const {
  for (const Herd& herd : herds_)
    for (const Page& page : herd.pages) {
      VkDrawIndexedIndirectCommand draws[shared::INSTANCE_LISTS];
      for (int list = 0; list < shared::INSTANCE_LISTS; ++list) {
        const bool camera = list < shared::CAMERA_LODS;
        const MeshLod& lod = herd.mesh.lods[size_t(camera ? list : kShadowLod[list - shared::CAMERA_LODS])];
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
  for (const Herd& herd : herds_)
    for (const Page& page : herd.pages) cull_.record(cmd, page.culled, herd.mesh.radius);
}

void CrowdDrawing::drawShadows(vk::CommandBuffer cmd, int cascade) const {
  for (uint32_t h = 0; h < herds_.size(); ++h)
    for (const Page& page : herds_[h].pages) {
      const shared::CrowdConstants constants{.view = uint32_t(shared::VIEW_CAMERA + 1 + cascade),
                                             .palette = herds_[h].palette,
                                             .firstAgent = page.firstAgent,
                                             .herd = h};
      herds_[h].shadow.use(cmd, page.shadow, gpu::bytesOf(constants));
      drawList(cmd, herds_[h], page, shared::CAMERA_LODS + cascade);
    }
}

void CrowdDrawing::draw(vk::CommandBuffer cmd) const {
  for (uint32_t h = 0; h < herds_.size(); ++h)
    for (const Page& page : herds_[h].pages) {
      const shared::CrowdConstants constants{.view = shared::VIEW_CAMERA,
                                             .palette = herds_[h].palette,
                                             .firstAgent = page.firstAgent,
                                             .herd = h};
      herds_[h].draw.use(cmd, page.draw, gpu::bytesOf(constants));
      for (int lod = 0; lod < shared::CAMERA_LODS; ++lod) drawList(cmd, herds_[h], page, lod);
    }
}

void CrowdDrawing::drawList(vk::CommandBuffer cmd, const Herd& herd, const Page& page, int list) const {
  // The list's place comes by the vertex buffer's offset: firstInstance in an indirect draw is optional in
  // Vulkan.
  const vk::DeviceSize place = vk::DeviceSize(list) * page.culled.agents * sizeof(uint32_t);
  const std::array buffers{herd.mesh.vertices.handle(), page.culled.instances.handle()};
  const std::array<vk::DeviceSize, 2> offsets{0, place};
  cmd.bindVertexBuffers(0, buffers, offsets);
  cmd.bindIndexBuffer(herd.mesh.indices.handle(), 0, vk::IndexType::eUint32);
  cmd.drawIndexedIndirect(page.culled.commands.handle(),
                          vk::DeviceSize(list) * sizeof(VkDrawIndexedIndirectCommand), 1,
                          sizeof(VkDrawIndexedIndirectCommand));
}

}  // namespace skitter::render

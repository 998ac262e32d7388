#include "drawing.h"

#include <algorithm>
#include <array>

#include "agents_frag.h"
#include "agents_vert.h"
#include "cull_comp.h"
#include "ground_frag.h"
#include "ground_vert.h"
#include "skitter/skin_mesh.h"

namespace host {
namespace {

// Push constants of the shaders of the same names.
struct CullConstants {
  glm::mat4 clip;
  glm::vec4 pixels;
  glm::vec3 eye;
  float pixelsAway;
  uint32_t agents, levels;
  float radius;
};
struct AgentConstants {
  glm::mat4 clip;
  glm::vec3 eye;
  uint32_t entries, list, picked;
};
struct GroundConstants {
  glm::mat4 clip;
  glm::vec3 eye;
  uint32_t columns, rows;
  float spacingX, spacingZ;
  alignas(16) glm::vec3 first;
};

}  // namespace

Drawing::Drawing(Gpu& gpu, skitter::Device& device, const skitter::Crowd& crowd, VkExtent2D extent)
    : ground_(crowd.terrain()) {
  using skitter::SkinVertex;
  colour_ = gpu.makeImage(extent, colourFormat,
                          VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                          VK_IMAGE_ASPECT_COLOR_BIT);
  depth_ = gpu.makeImage(extent, depthFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                         VK_IMAGE_ASPECT_DEPTH_BIT);
  cullPipeline_ = gpu.makeCompute(cull_comp, 3, sizeof(CullConstants));
  agentPipeline_ =
      gpu.makeDrawing({.vertex = agents_vert,
                       .fragment = agents_frag,
                       .storageBuffers = 2,
                       .pushBytes = sizeof(AgentConstants),
                       .vertexStride = sizeof(SkinVertex),
                       .attributes = {{VK_FORMAT_R32G32B32_SFLOAT, offsetof(SkinVertex, position)},
                                      {VK_FORMAT_R32G32B32_SFLOAT, offsetof(SkinVertex, normal)},
                                      {VK_FORMAT_R32G32B32_SFLOAT, offsetof(SkinVertex, colour)},
                                      {VK_FORMAT_R16G16B16A16_UINT, offsetof(SkinVertex, bones)},
                                      {VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(SkinVertex, weights)}},
                       .colour = colourFormat,
                       .depth = depthFormat});
  groundPipeline_ = gpu.makeDrawing({.vertex = ground_vert,
                                     .fragment = ground_frag,
                                     .storageBuffers = 1,
                                     .pushBytes = sizeof(GroundConstants),
                                     .colour = colourFormat,
                                     .depth = depthFormat});
  const Buffer heights = gpu.makeBuffer(ground_.heights, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  groundSet_ = gpu.bind(groundPipeline_, {heights.handle});
  for (uint32_t herd = 0; herd < crowd.herdCount(); ++herd)
    if (skitter::Palettes::agentsOf(crowd, herd) > 0) herds_.push_back(makeHerd(gpu, device, crowd, herd));
}

Drawing::Herd Drawing::makeHerd(Gpu& gpu, skitter::Device& device, const skitter::Crowd& crowd,
                                uint32_t herd) const {
  using skitter::TransformFormat;
  const skitter::SkinMesh mesh = skitter::skinMeshOf(crowd, herd);
  Herd made;
  made.agents = skitter::Palettes::agentsOf(crowd, herd);
  made.entries = mesh.entries;
  made.radius = mesh.radius;
  made.vertices = gpu.makeBuffer(mesh.vertices, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  made.indices = gpu.makeBuffer(mesh.indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
  for (const skitter::SkinMesh::Level& level : mesh.levels) {
    if (made.levels.size() < 4) made.pixels[static_cast<int>(made.levels.size())] = level.pixels;
    made.levels.push_back({.indexCount = level.indexCount,
                           .instanceCount = 0,
                           .firstIndex = level.firstIndex,
                           .vertexOffset = 0,
                           .firstInstance = 0});
  }
  std::vector<skitter::PaletteTarget> targets;
  for (uint32_t i = 0; i < framesInFlight; ++i) {
    Slot& slot = made.slots.emplace_back();
    const auto storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    slot.palettes =
        gpu.makeBuffer(uint64_t{made.agents} * made.entries * bytesOf(TransformFormat::matrix), storage);
    slot.instances = gpu.makeBuffer(uint64_t{made.agents} * bytesOf(TransformFormat::quaternion), storage);
    slot.visible = gpu.makeBuffer(uint64_t{made.agents} * made.levels.size() * sizeof(uint32_t), storage);
    slot.draws =
        gpu.makeBuffer(made.levels.size() * sizeof(VkDrawIndexedIndirectCommand),
                       storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    slot.cull = gpu.bind(cullPipeline_, {slot.instances.handle, slot.visible.handle, slot.draws.handle});
    slot.draw = gpu.bind(agentPipeline_, {slot.palettes.handle, slot.visible.handle});
    targets.push_back({.instances = {.buffer = slot.instances.handle,
                                     .bytes = slot.instances.bytes,
                                     .format = TransformFormat::quaternion},
                       .palettes = {.buffer = slot.palettes.handle, .bytes = slot.palettes.bytes}});
  }
  made.palettes = std::make_unique<skitter::Palettes>(device, crowd, herd, targets);
  return made;
}

void Drawing::recordPalettes(VkCommandBuffer cmd, const glm::dvec3& origin, uint32_t slot) const {
  for (const Herd& herd : herds_) herd.palettes->record(cmd, origin, slot);
}

void Drawing::cull(VkCommandBuffer cmd, const View& view, uint32_t slot) const {
  for (const Herd& herd : herds_)
    vkCmdUpdateBuffer(cmd, herd.slots[slot].draws.handle, 0,
                      herd.levels.size() * sizeof(VkDrawIndexedIndirectCommand), herd.levels.data());
  barrier(cmd, VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
          VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
          VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
  for (const Herd& herd : herds_) {
    const CullConstants constants{.clip = view.clip,
                                  .pixels = herd.pixels,
                                  .eye = view.eye,
                                  .pixelsAway = view.pixelsAway,
                                  .agents = herd.agents,
                                  .levels = static_cast<uint32_t>(herd.levels.size()),
                                  .radius = herd.radius};
    use(cmd, cullPipeline_, herd.slots[slot].cull, constants);
    vkCmdDispatch(cmd, (herd.agents + 63) / 64, 1, 1);
  }
  barrier(cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
          VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT,
          VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
}

void Drawing::drawGround(VkCommandBuffer cmd, const View& view) const {
  const glm::dvec3 first = glm::dvec3(ground_.originX(), 0, ground_.originZ()) - view.origin;
  const GroundConstants constants{.clip = view.clip,
                                  .eye = view.eye,
                                  .columns = ground_.columns,
                                  .rows = ground_.rows,
                                  .spacingX = ground_.spacingX,
                                  .spacingZ = ground_.spacingZ,
                                  .first = first};
  use(cmd, groundPipeline_, groundSet_, constants);
  vkCmdDraw(cmd, 6 * (ground_.columns - 1) * (ground_.rows - 1), 1, 0, 0);
}

void Drawing::drawHerds(VkCommandBuffer cmd, const View& view, uint32_t slot) const {
  for (uint32_t h = 0; h < herds_.size(); ++h) {
    const Herd& herd = herds_[h];
    const VkDeviceSize zero = 0;
    vkCmdBindVertexBuffers(cmd, 0, 1, &herd.vertices.handle, &zero);
    vkCmdBindIndexBuffer(cmd, herd.indices.handle, 0, VK_INDEX_TYPE_UINT32);
    for (uint32_t level = 0; level < herd.levels.size(); ++level) {
      const AgentConstants constants{.clip = view.clip,
                                     .eye = view.eye,
                                     .entries = herd.entries,
                                     .list = level * herd.agents,
                                     .picked = h == markedHerd_ ? marked_ : UINT32_MAX};
      use(cmd, agentPipeline_, herd.slots[slot].draw, constants);
      vkCmdDrawIndexedIndirect(cmd, herd.slots[slot].draws.handle,
                               level * sizeof(VkDrawIndexedIndirectCommand), 1,
                               sizeof(VkDrawIndexedIndirectCommand));
    }
  }
}

void Drawing::record(VkCommandBuffer cmd, const View& view, uint32_t slot) const {
  cull(cmd, view, slot);
  // What the images held is of no interest; the last frame's copy of the picture is waited for.
  transition(cmd, colour_.handle, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
             VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, 0,
             VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT);
  const auto depthStages =
      VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
  transition(cmd, depth_.handle, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
             VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, depthStages,
             VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, depthStages,
             VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT);
  VkRenderingAttachmentInfo colour{};
  colour.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  colour.imageView = colour_.view;
  colour.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  colour.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  colour.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  colour.clearValue.color = {{0.80f, 0.86f, 0.91f, 1}};
  VkRenderingAttachmentInfo depth{};
  depth.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  depth.imageView = depth_.view;
  depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  depth.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  depth.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  depth.clearValue.depthStencil = {1, 0};
  VkRenderingInfo rendering{};
  rendering.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
  rendering.renderArea = {{0, 0}, colour_.extent};
  rendering.layerCount = 1;
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachments = &colour;
  rendering.pDepthAttachment = &depth;
  vkCmdBeginRendering(cmd, &rendering);
  const VkViewport viewport{
      0, 0, static_cast<float>(colour_.extent.width), static_cast<float>(colour_.extent.height), 0, 1};
  vkCmdSetViewport(cmd, 0, 1, &viewport);
  vkCmdSetScissor(cmd, 0, 1, &rendering.renderArea);
  drawGround(cmd, view);
  drawHerds(cmd, view, slot);
  vkCmdEndRendering(cmd);
  transition(cmd, colour_.handle, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
             VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
             VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
             VK_ACCESS_2_TRANSFER_READ_BIT);
}

}  // namespace host

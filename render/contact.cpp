#include "render/contact.h"

#include <array>
#include <cstddef>

#include "crowd/controller.h"
#include "embedded/contact_frag.h"
#include "embedded/contact_vert_storage.h"
#include "embedded/contact_vert_texel.h"
#include "gpu/transfer.h"
#include "render/bindings.h"

namespace skitter::render {
namespace {

struct ContactVertex {
  glm::vec4 foot, where;  // shaders/render/contact.vert
  uint32_t bone;
};

// Of a foot, in reaches of its leg; of a body, in its radii and heights. A body keeps less of the sky off
// than its shadow already takes.
constexpr float kFootRadius = 0.16f, kFootHeight = 0.12f, kFootShare = 0.65f;
constexpr float kBodyRadius = 1.1f, kBodyHeight = 1.8f, kBodyShare = 0.5f;
constexpr int kFootCells = 2, kBodyCells = 6;  // along a square, which bends with the ground

struct Squares {
  std::vector<ContactVertex> vertices;
  std::vector<uint32_t> indices;

  void add(uint32_t bone, const glm::vec4& foot, float radius, float share, int cells) {
    const auto first = uint32_t(vertices.size()), side = uint32_t(cells) + 1;
    for (uint32_t z = 0; z < side; ++z)
      for (uint32_t x = 0; x < side; ++x) {
        const glm::vec2 at = 2.0f * glm::vec2(float(x), float(z)) / float(cells) - 1.0f;
        vertices.push_back({.foot = foot, .where = {at.x, at.y, radius, share}, .bone = bone});
      }
    for (uint32_t z = 0; z + 1 < side; ++z)
      for (uint32_t x = 0; x + 1 < side; ++x) {
        const uint32_t a = first + z * side + x, b = a + 1, c = a + side, d = c + 1;
        for (const uint32_t i : {a, c, b, b, c, d}) indices.push_back(i);
      }
  }
};

Squares squaresOf(const Rig& rig, const Limbs& limbs) {
  Squares squares;
  squares.add(limbs.carriers[0].entry, glm::vec4(0, 0, 0, kBodyHeight * rig.bodyHeight),
              kBodyRadius * rig.bodyRadius, kBodyShare, kBodyCells);
  for (size_t l = 0; l < rig.legs.size(); ++l) {
    const std::vector<Bone>& bones = limbs.rig.legs[l].bones;
    const float reach = rig.legs[l].reach;
    const Limbs::Carrier& last = limbs.carriers[l * size_t(limbs.rig.maxBones()) + bones.size()];
    squares.add(last.entry,
                glm::vec4(last.start + bones.back().direction * bones.back().length, kFootHeight * reach),
                kFootRadius * reach, kFootShare, kFootCells);
  }
  return squares;
}

}  // namespace

Contact::Contact(const Setting& s, const crowd::Kind& kind, const Limbs& limbs) {
  const Squares squares = squaresOf(kind.rig, limbs);
  indexCount_ = uint32_t(squares.indices.size());
  vertices_ = gpu::Buffer(s.context, squares.vertices.size() * sizeof(ContactVertex), "contact vertices",
                          gpu::BufferUse::vertex);
  indices_ = gpu::Buffer(s.context, squares.indices.size() * sizeof(uint32_t), "contact indices",
                         gpu::BufferUse::index);
  gpu::upload(s.context, vertices_, squares.vertices);
  gpu::upload(s.context, indices_, squares.indices);
  using F = vk::Format;
  using gpu::BindingKind;
  pipeline_ = gpu::GraphicsPipeline(
      s.context,
      s.dimming({.name = "contact",
                 .vertex = {embedded::contact_vert_texel(), embedded::contact_vert_storage()},
                 .fragment = embedded::contact_frag(),
                 .bindings = {{shared::DRAW_PICTURE, BindingKind::uniform},
                              {shared::DRAW_BODY, BindingKind::load4},
                              {shared::DRAW_POSE, BindingKind::load4},
                              {shared::DRAW_HEIGHTS, BindingKind::heights}},
                 .pushBytes = sizeof(shared::CrowdConstants),
                 .streams = {{.stride = sizeof(ContactVertex),
                              .rate = vk::VertexInputRate::eVertex,
                              .attributes = {{1, F::eR32Uint, offsetof(ContactVertex, bone)},
                                             {2, F::eR32G32B32A32Sfloat, offsetof(ContactVertex, foot)},
                                             {3, F::eR32G32B32A32Sfloat, offsetof(ContactVertex, where)}}},
                             {.stride = sizeof(uint32_t),
                              .rate = vk::VertexInputRate::eInstance,
                              .attributes = {{0, F::eR32Uint, 0}}}},
                 .constants = {{shared::CONSTANT_ROOTS, s.filtered()},
                               {shared::CONSTANT_STUMPS, kind.hurts},
                               {shared::CONSTANT_MATRICES, crowd::traitsOf(kind.controller).playsClips}}}));
}

Contact::Page Contact::makePage(const Setting& s, const gpu::Buffer& body, const gpu::Buffer& pose) const {
  const std::vector<gpu::Binding> list{{shared::DRAW_PICTURE, &s.picture},
                                       {shared::DRAW_BODY, &body},
                                       {shared::DRAW_POSE, &pose},
                                       {shared::DRAW_HEIGHTS, &s.heights}};
  Page page;
  page.bindings = pipeline_.bind(s.context, list);
  const std::vector<VkDrawIndexedIndirectCommand> draw(1, {.indexCount = indexCount_,
                                                           .instanceCount = 0,
                                                           .firstIndex = 0,
                                                           .vertexOffset = 0,
                                                           .firstInstance = 0});
  page.draw = gpu::Buffer(s.context, sizeof draw[0], "contact draw", gpu::BufferUse::indirect);
  gpu::upload(s.context, page.draw, draw);
  return page;
}

void Contact::count(vk::CommandBuffer cmd, const Page& page, const CulledPage& culled) const {
  constexpr vk::DeviceSize at = offsetof(VkDrawIndexedIndirectCommand, instanceCount);
  cmd.copyBuffer(culled.commands.handle(), page.draw.handle(),
                 vk::BufferCopy{.srcOffset = shared::CONTACTS * sizeof(VkDrawIndexedIndirectCommand) + at,
                                .dstOffset = at,
                                .size = sizeof(uint32_t)});
}

void Contact::draw(vk::CommandBuffer cmd, const Page& page, const CulledPage& culled,
                   uint32_t palette) const {
  const shared::CrowdConstants constants{
      .view = shared::VIEW_CAMERA, .palette = palette, .firstAgent = 0, .kind = 0};
  pipeline_.use(cmd, page.bindings, gpu::bytesOf(constants));
  cmd.bindIndexBuffer(indices_.handle(), 0, vk::IndexType::eUint32);
  const std::array buffers{vertices_.handle(), culled.instances.handle()};
  const std::array<vk::DeviceSize, 2> offsets{
      0, vk::DeviceSize(shared::CONTACTS) * culled.agents * sizeof(uint32_t)};
  cmd.bindVertexBuffers(0, 2, buffers.data(), offsets.data());
  cmd.drawIndexedIndirect(page.draw.handle(), 0, 1, sizeof(VkDrawIndexedIndirectCommand));
}

}  // namespace skitter::render

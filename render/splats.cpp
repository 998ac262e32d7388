#include "render/splats.h"

#include "crowd/controller.h"
#include "embedded/shade_frag.h"
#include "embedded/splat_comp_storage.h"
#include "embedded/splat_comp_texel.h"
#include "embedded/splat_frag.h"
#include "embedded/splat_vert.h"
#include "gpu/transfer.h"
#include "render/bindings.h"
#include "render/mesh.h"
#include "render/splat_parts.h"

namespace skitter::render {
namespace {

using gpu::BindingKind;

constexpr float kBendPixels = 1;  // that a joint may be off a part at rest, of the largest agent
constexpr uint32_t kCorners = 6;  // of a square's triangles

uint32_t tilesAlong(uint32_t pixels) { return (pixels + shared::SPLAT_TILE - 1) / shared::SPLAT_TILE; }
uint32_t tilesOf(const vk::Extent2D& extent) { return tilesAlong(extent.width) * tilesAlong(extent.height); }

}  // namespace

Splats::Splats(const Setting& s)
    : extent_(s.extent), splatPixels_(kSplatPixels / s.detail), shadePixels_(kShadePixels / s.detail) {
  const uint64_t bytes = 2 * uint64_t(extent_.width) * extent_.height * sizeof(uint32_t);
  const DeviceLimits& limits = s.context.limits();
  if (bytes > limits.maxStorageBufferRange || bytes >= limits.maxAllocationBytes) return;
  splats_ = gpu::Buffer(s.context, bytes, "splats");
  tiles_ = gpu::Buffer(s.context, uint64_t(tilesOf(extent_)) * sizeof(uint32_t), "squares with splats");
  draw_ = gpu::GraphicsPipeline(s.context, {.name = "splats",
                                            .vertex = embedded::splat_vert(),
                                            .fragment = embedded::splat_frag(),
                                            .bindings = {{shared::DRAW_SPLATS, BindingKind::store},
                                                         {shared::DRAW_SPLAT_TILES, BindingKind::store}},
                                            .pushBytes = sizeof(shared::SplatConstants),
                                            .colour = s.colour,
                                            .depth = s.depth,
                                            .samples = s.samples,
                                            .cull = {},
                                            .constants = {{shared::CONSTANT_ROOTS, s.filtered()}}});
  const std::vector<gpu::Binding> list{{shared::DRAW_SPLATS, &splats_}, {shared::DRAW_SPLAT_TILES, &tiles_}};
  drawBindings_ = draw_.bind(s.context, list);
  shade_ = gpu::GraphicsPipeline(s.context,
                                 s.dimming({.name = "shades of splats",
                                            .vertex = embedded::splat_vert(),
                                            .fragment = embedded::shade_frag(),
                                            .bindings = {{shared::DRAW_PICTURE, BindingKind::uniform},
                                                         {shared::DRAW_SPLATS, BindingKind::store},
                                                         {shared::DRAW_SPLAT_TILES, BindingKind::store}},
                                            .pushBytes = sizeof(shared::SplatConstants),
                                            .constants = s.lit()}));
  const std::vector<gpu::Binding> shades{{shared::DRAW_PICTURE, &s.picture},
                                         {shared::DRAW_SPLATS, &splats_},
                                         {shared::DRAW_SPLAT_TILES, &tiles_}};
  shadeBindings_ = shade_.bind(s.context, shades);
}

Splats::Kind Splats::makeKind(const Setting& s, const crowd::Kind& source, const Limbs& limbs,
                              float radius) const {
  Kind kind;
  if (!*this) return kind;
  const std::vector<shared::SplatPart> parts = splatPartsOf(limbs, kBendPixels * radius / kSplatPixels);
  if (parts.empty()) return kind;
  kind.radius = radius;
  kind.parts = gpu::Buffer(s.context, parts.size() * sizeof parts[0], "splat parts");
  gpu::upload(s.context, kind.parts, parts);
  std::vector<gpu::SpecConstant> constants = s.light;
  constants.emplace_back(shared::CONSTANT_ROOTS, true);
  constants.emplace_back(shared::CONSTANT_TINTED, source.tinted);
  constants.emplace_back(shared::CONSTANT_STUMPS, source.hurts);
  constants.emplace_back(shared::CONSTANT_MATRICES, crowd::traitsOf(source.controller).playsClips);
  constants.emplace_back(shared::CONSTANT_SPLAT_PARTS, int32_t(parts.size()));
  kind.kernel =
      gpu::Kernel(s.context, {.name = "splat",
                              .code = {embedded::splat_comp_texel(), embedded::splat_comp_storage()},
                              .bindings = {{shared::DRAW_PICTURE, BindingKind::uniform},
                                           {shared::DRAW_BODY, BindingKind::load4},
                                           {shared::DRAW_POSE, BindingKind::load4},
                                           {shared::DRAW_TINT, BindingKind::load4},
                                           {shared::DRAW_HEIGHTS, BindingKind::heights},
                                           {shared::DRAW_GROUND, BindingKind::texture},
                                           {shared::DRAW_SHADOW, BindingKind::texture},
                                           {shared::DRAW_INSTANCES, BindingKind::store},
                                           {shared::DRAW_COMMANDS, BindingKind::store},
                                           {shared::DRAW_SPLAT_PARTS, BindingKind::load4},
                                           {shared::DRAW_SPLATS, BindingKind::store},
                                           {shared::DRAW_SPLAT_TILES, BindingKind::store}},
                              .pushBytes = sizeof(shared::SplatConstants),
                              .constants = constants});
  return kind;
}

gpu::Bindings Splats::bind(const Setting& s, const Kind& kind, const gpu::Buffer& body,
                           const gpu::Buffer& pose, const gpu::Buffer& tint, const CulledPage& culled) const {
  return kind.kernel.bind(s.context, {{shared::DRAW_PICTURE, &s.picture},
                                      {shared::DRAW_BODY, &body},
                                      {shared::DRAW_POSE, &pose},
                                      {shared::DRAW_TINT, &tint},
                                      {shared::DRAW_HEIGHTS, &s.heights},
                                      {shared::DRAW_GROUND, &s.ground, s.groundSampler},
                                      {shared::DRAW_SHADOW, &s.shadow.image(), s.shadow.sampler()},
                                      {shared::DRAW_INSTANCES, &culled.instances},
                                      {shared::DRAW_COMMANDS, &culled.commands},
                                      {shared::DRAW_SPLAT_PARTS, &kind.parts},
                                      {shared::DRAW_SPLATS, &splats_},
                                      {shared::DRAW_SPLAT_TILES, &tiles_}});
}

shared::SplatConstants Splats::picture() const {
  shared::SplatConstants constants{};
  constants.width = extent_.width;
  constants.height = extent_.height;
  constants.splatPixels = splatPixels_;
  constants.shadePixels = shadePixels_;
  return constants;
}

void Splats::prepare(vk::CommandBuffer cmd) const {
  cmd.fillBuffer(splats_.handle(), 0, VK_WHOLE_SIZE, 0);
  cmd.fillBuffer(tiles_.handle(), 0, VK_WHOLE_SIZE, 0);
}

void Splats::record(vk::CommandBuffer cmd, const Kind& kind, const gpu::Bindings& page,
                    const CulledPage& culled, const shared::CrowdConstants& of) const {
  shared::SplatConstants constants = picture();
  constants.palette = of.palette;
  constants.firstAgent = of.firstAgent;
  constants.kind = of.kind;
  constants.agents = culled.agents;
  constants.radius = kind.radius;
  kind.kernel.dispatchIndirect(cmd, page, gpu::bytesOf(constants), culled.commands,
                               groupsOffset(shared::SPLATS));
}

void Splats::draw(vk::CommandBuffer cmd) const {
  const shared::SplatConstants constants = picture();
  draw_.use(cmd, drawBindings_, gpu::bytesOf(constants));
  cmd.draw(kCorners, tilesOf(extent_), 0, 0);
}

void Splats::drawShades(vk::CommandBuffer cmd) const {
  const shared::SplatConstants constants = picture();
  shade_.use(cmd, shadeBindings_, gpu::bytesOf(constants));
  cmd.draw(kCorners, tilesOf(extent_), 0, 0);
}

}  // namespace skitter::render

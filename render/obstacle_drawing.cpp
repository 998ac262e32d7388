#include "render/obstacle_drawing.h"

#include <algorithm>
#include <cstddef>

#include "embedded/obstacle_frag.h"
#include "embedded/obstacle_vert.h"
#include "gpu/transfer.h"
#include "render/bindings.h"
#include "render/obstacle_mesh.h"

namespace skitter::render {
namespace {

// A share of the longest leg: higher than any creature steps over, low enough to look across.
constexpr float kHeightInLegs = 0.75f;
constexpr float kLeastStep = 0.5f;  // metres between vertices below which a wall gains nothing

float heightFor(const Crowd::Impl& crowd) {
  float leg = 0;
  for (const crowd::Kind& kind : crowd.kinds)
    if (!kind.pages.empty()) leg = std::max(leg, kind.rig.legLength);
  return kHeightInLegs * (leg > 0 ? leg : 1);
}

std::vector<gpu::VertexStream> obstacleStreams() {
  return {{.stride = sizeof(ObstacleVertex),
           .rate = vk::VertexInputRate::eVertex,
           .attributes = {{0, vk::Format::eR32G32B32Sfloat, offsetof(ObstacleVertex, place)},
                          {1, vk::Format::eR32G32B32Sfloat, offsetof(ObstacleVertex, normal)}}}};
}

}  // namespace

ObstacleDrawing::ObstacleDrawing(const Setting& s, const Crowd::Impl& crowd) {
  if (crowd.scene.obstacles.empty()) return;
  const ObstacleMesh mesh =
      obstacleMesh(crowd.scene.obstacles, heightFor(crowd),
                   std::max(kLeastStep, std::min(s.terrain.spacingX, s.terrain.spacingZ)));
  indexCount_ = static_cast<uint32_t>(mesh.indices.size());
  vertices_ = gpu::Buffer(s.context, mesh.vertices.size() * sizeof(ObstacleVertex), "obstacle vertices",
                          gpu::BufferUse::vertex);
  indices_ = gpu::Buffer(s.context, mesh.indices.size() * sizeof(uint32_t), "obstacle indices",
                         gpu::BufferUse::index);
  gpu::upload(s.context, vertices_, mesh.vertices);
  gpu::upload(s.context, indices_, mesh.indices);

  using gpu::BindingKind;
  gpu::GraphicsInfo info{.name = "obstacle shadow",
                         .vertex = embedded::obstacle_vert(),
                         .fragment = {},
                         .bindings = {{shared::DRAW_PICTURE, BindingKind::uniform},
                                      {shared::DRAW_HEIGHTS, BindingKind::heights},
                                      {shared::DRAW_GROUND, BindingKind::texture}},
                         .pushBytes = sizeof(shared::ObstacleConstants),
                         .streams = obstacleStreams(),
                         .depth = s.shadow.image().format(),
                         .depthUse = gpu::DepthUse::shadow,
                         .cull = {}};
  std::vector<gpu::Binding> list{{shared::DRAW_PICTURE, &s.picture},
                                 {shared::DRAW_HEIGHTS, &s.heights},
                                 {shared::DRAW_GROUND, &s.ground, s.groundSampler}};
  shadow_ = gpu::GraphicsPipeline(s.context, info);
  shadowBindings_ = shadow_.bind(s.context, list);

  info.name = "obstacles";
  info.fragment = embedded::obstacle_frag();
  info.bindings.push_back({shared::DRAW_SHADOW, BindingKind::texture});
  info.colour = s.colour;
  info.depth = s.depth;
  info.samples = s.samples;
  info.depthUse = gpu::DepthUse::reversed;
  info.cull = vk::CullModeFlagBits::eBack;
  info.constants = s.lit();
  list.push_back({shared::DRAW_SHADOW, &s.shadow.image(), s.shadow.sampler()});
  draw_ = gpu::GraphicsPipeline(s.context, info);
  drawBindings_ = draw_.bind(s.context, list);
}

void ObstacleDrawing::drawShadows(vk::CommandBuffer cmd, int cascade) const {
  drawAll(cmd, shadow_, shadowBindings_, shared::VIEW_CAMERA + 1 + cascade);
}

void ObstacleDrawing::draw(vk::CommandBuffer cmd) const {
  drawAll(cmd, draw_, drawBindings_, shared::VIEW_CAMERA);
}

void ObstacleDrawing::drawAll(vk::CommandBuffer cmd, const gpu::GraphicsPipeline& pipeline,
                              const gpu::Bindings& bindings, int view) const {
  if (indexCount_ == 0) return;
  const shared::ObstacleConstants constants{.view = static_cast<uint32_t>(view)};
  pipeline.use(cmd, bindings, gpu::bytesOf(constants));
  cmd.bindVertexBuffers(0, vertices_.handle(), vk::DeviceSize(0));
  cmd.bindIndexBuffer(indices_.handle(), 0, vk::IndexType::eUint32);
  cmd.drawIndexed(indexCount_, 1, 0, 0, 0);
}

}  // namespace skitter::render

#include "render/occlusion.h"

#include "crowd/controller.h"
#include "embedded/depth_pyramid_comp.h"
#include "embedded/depth_pyramid_of_samples_comp.h"
#include "embedded/first_look_comp.h"
#include "embedded/second_look_comp_storage.h"
#include "embedded/second_look_comp_texel.h"
#include "gpu/transfer.h"
#include "render/bindings.h"
#include "render/hulls.h"
#include "skitter/records.h"

namespace skitter::render {
namespace {

using gpu::BindingKind;

// Squares of a level of the pyramid.
uint32_t squaresOf(const vk::Extent2D& extent, int level) {
  return uint32_t(shared::pyramidSquares(int(extent.width), level) *
                  shared::pyramidSquares(int(extent.height), level));
}

}  // namespace

Occlusion::Occlusion(const Setting& s) : extent_(s.extent) {
  if (s.occluders == nullptr) return;
  first_ = gpu::Kernel(s.context, {.name = "first look",
                                   .code = embedded::first_look_comp(),
                                   .bindings = {{shared::DRAW_INSTANCES, BindingKind::store},
                                                {shared::DRAW_COMMANDS, BindingKind::store},
                                                {shared::DRAW_SEEN, BindingKind::store}},
                                   .pushBytes = sizeof(shared::OcclusionConstants)});
  pyramid_ = gpu::Kernel(
      s.context,
      {.name = "depth pyramid",
       .code = s.filtered() ? embedded::depth_pyramid_comp() : embedded::depth_pyramid_of_samples_comp(),
       .bindings = {{shared::DRAW_DEPTH, BindingKind::heights}, {shared::DRAW_PYRAMID, BindingKind::store}},
       .pushBytes = sizeof(shared::PyramidConstants)});
  uint64_t all = 0;
  for (int level = 0; level < shared::PYRAMID_LEVELS; ++level) all += squaresOf(extent_, level);
  squares_ = gpu::Buffer(s.context, all * sizeof(float), "depth pyramid");
  pyramidBindings_ =
      pyramid_.bind(s.context, {{shared::DRAW_DEPTH, s.occluders}, {shared::DRAW_PYRAMID, &squares_}});
}

Occlusion::Kind Occlusion::makeKind(const Setting& s, const crowd::Kind& source, const MeshData& mesh,
                                    uint32_t palette) const {
  const std::vector<shared::HullBox> boxes = hullsOf(mesh);
  Kind kind;
  kind.palette = palette;
  kind.boxCount = uint32_t(boxes.size());
  kind.boxes = gpu::Buffer(s.context, boxes.size() * sizeof boxes[0], "hulls");
  if (!boxes.empty()) gpu::upload(s.context, kind.boxes, boxes);
  kind.second = gpu::Kernel(
      s.context, {.name = "second look",
                  .code = {embedded::second_look_comp_texel(), embedded::second_look_comp_storage()},
                  .bindings = {{shared::DRAW_PICTURE, BindingKind::uniform},
                               {shared::DRAW_BODY, BindingKind::load4},
                               {shared::DRAW_POSE, BindingKind::load4},
                               {shared::DRAW_HULLS, BindingKind::load4},
                               {shared::DRAW_INSTANCES, BindingKind::store},
                               {shared::DRAW_COMMANDS, BindingKind::store},
                               {shared::DRAW_SEEN, BindingKind::store},
                               {shared::DRAW_PYRAMID, BindingKind::store}},
                  .pushBytes = sizeof(shared::OcclusionConstants),
                  .constants = {{shared::CONSTANT_MATRICES, crowd::traitsOf(source.controller).playsClips},
                                {shared::CONSTANT_STUMPS, source.hurts}}});
  return kind;
}

Occlusion::Page Occlusion::makePage(const Setting& s, const Kind& kind, const gpu::Buffer& body,
                                    const gpu::Buffer& pose, const CulledPage& culled) const {
  Page page;
  page.seen = gpu::Buffer(s.context, uint64_t(culled.agents) * sizeof(uint32_t), "agents seen");
  gpu::clear(s.context, page.seen);
  page.first = first_.bind(s.context, {{shared::DRAW_INSTANCES, &culled.instances},
                                       {shared::DRAW_COMMANDS, &culled.commands},
                                       {shared::DRAW_SEEN, &page.seen}});
  page.second = kind.second.bind(s.context, {{shared::DRAW_PICTURE, &s.picture},
                                             {shared::DRAW_BODY, &body},
                                             {shared::DRAW_POSE, &pose},
                                             {shared::DRAW_HULLS, &kind.boxes},
                                             {shared::DRAW_INSTANCES, &culled.instances},
                                             {shared::DRAW_COMMANDS, &culled.commands},
                                             {shared::DRAW_SEEN, &page.seen},
                                             {shared::DRAW_PYRAMID, &squares_}});
  return page;
}

shared::OcclusionConstants Occlusion::constantsOf(const CulledPage& culled) const {
  return {
      .agents = culled.agents, .palette = 0, .width = extent_.width, .height = extent_.height, .boxes = 0};
}

void Occlusion::lookFirst(vk::CommandBuffer cmd, const CulledPage& culled, const Page& page) const {
  first_.dispatch(cmd, page.first, gpu::bytesOf(constantsOf(culled)),
                  gpu::groupsFor(culled.agents, shared::WORK_GROUP));
}

void Occlusion::makePyramid(vk::CommandBuffer cmd) const {
  for (int level = 0; level < shared::PYRAMID_LEVELS; ++level) {
    const shared::PyramidConstants constants{
        .width = extent_.width, .height = extent_.height, .level = uint32_t(level)};
    pyramid_.dispatch(cmd, pyramidBindings_, gpu::bytesOf(constants),
                      gpu::groupsFor(squaresOf(extent_, level), shared::WORK_GROUP));
    gpu::computeToCompute(cmd);
  }
}

void Occlusion::lookAgain(vk::CommandBuffer cmd, const Kind& kind, const CulledPage& culled,
                          const Page& page) const {
  shared::OcclusionConstants constants = constantsOf(culled);
  constants.palette = kind.palette;
  constants.boxes = kind.boxCount;
  kind.second.dispatch(cmd, page.second, gpu::bytesOf(constants),
                       gpu::groupsFor(culled.agents, shared::WORK_GROUP));
}

}  // namespace skitter::render

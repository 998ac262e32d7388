#include "render/interpolation.h"

#include "embedded/interpolate_bodies_comp_storage.h"
#include "embedded/interpolate_bodies_comp_texel.h"
#include "embedded/interpolate_poses_comp_storage.h"
#include "embedded/interpolate_poses_comp_texel.h"
#include "render/bindings.h"
#include "skitter/records.h"

namespace skitter::render {

using gpu::BindingKind;

namespace {

gpu::Kernel posesKernel(const gpu::Context& context, bool matrices) {
  return {context,
          {.name = "interpolate poses",
           .code = {embedded::interpolate_poses_comp_texel(), embedded::interpolate_poses_comp_storage()},
           .bindings = {{shared::DRAW_POSE, BindingKind::load4},
                        {shared::DRAW_SHOWN_BODY, BindingKind::load4},
                        {shared::DRAW_SHOWN_BODY_OUT, BindingKind::store},
                        {shared::DRAW_SHOWN_POSE, BindingKind::load4},
                        {shared::DRAW_SHOWN_POSE_OUT, BindingKind::store},
                        {shared::DRAW_INSTANCES, BindingKind::store},
                        {shared::DRAW_COMMANDS, BindingKind::store}},
           .pushBytes = sizeof(shared::InterpolationConstants),
           .constants = {{shared::CONSTANT_MATRICES, matrices}}}};
}

}  // namespace

Interpolation::Interpolation(const gpu::Context& context)
    : bodies_(context, {.name = "interpolate bodies",
                        .code = {embedded::interpolate_bodies_comp_texel(),
                                 embedded::interpolate_bodies_comp_storage()},
                        .bindings = {{shared::DRAW_BODY, BindingKind::load4},
                                     {shared::DRAW_RATE, BindingKind::load4},
                                     {shared::DRAW_SHOWN_BODY, BindingKind::load4},
                                     {shared::DRAW_SHOWN_BODY_OUT, BindingKind::store}},
                        .pushBytes = sizeof(shared::InterpolationConstants)}) {}

Interpolation::Page Interpolation::makePage(const gpu::Context& context, const Source& source) const {
  Page page;
  page.body = gpu::Buffer(context, source.body.size(), "shown bodies");
  if (source.pose) {
    page.pose = gpu::Buffer(context, source.pose.size(), "shown poses");
    page.kernel = posesKernel(context, source.matrices);
  }
  page.bodies = bodies_.bind(context, {{shared::DRAW_BODY, &source.body},
                                       {shared::DRAW_RATE, &source.rate},
                                       {shared::DRAW_SHOWN_BODY, &page.body},
                                       {shared::DRAW_SHOWN_BODY_OUT, &page.body}});
  return page;
}

void Interpolation::bindLists(const gpu::Context& context, const Source& source, const CulledPage& culled,
                              Page& page) const {
  if (!page.kernel) return;
  page.poses = page.kernel.bind(context, {{shared::DRAW_POSE, &source.pose},
                                          {shared::DRAW_SHOWN_BODY, &page.body},
                                          {shared::DRAW_SHOWN_BODY_OUT, &page.body},
                                          {shared::DRAW_SHOWN_POSE, &page.pose},
                                          {shared::DRAW_SHOWN_POSE_OUT, &page.pose},
                                          {shared::DRAW_INSTANCES, &culled.instances},
                                          {shared::DRAW_COMMANDS, &culled.commands}});
}

void Interpolation::recordBodies(vk::CommandBuffer cmd, const Page& page,
                                 const shared::InterpolationConstants& constants) const {
  bodies_.dispatch(cmd, page.bodies, gpu::bytesOf(constants),
                   gpu::groupsFor(constants.agents, shared::WORK_GROUP));
}

void Interpolation::recordPoses(vk::CommandBuffer cmd, const Page& page, const CulledPage& culled,
                                const shared::InterpolationConstants& constants) const {
  if (page.kernel)
    page.kernel.dispatchIndirect(cmd, page.poses, gpu::bytesOf(constants), culled.commands,
                                 groupsOffset(shared::SHOWN));
}

}  // namespace skitter::render

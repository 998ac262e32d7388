#include "render/cull.h"

#include <algorithm>

#include "embedded/cull_comp_storage.h"
#include "embedded/cull_comp_texel.h"
#include "render/bindings.h"
#include "render/mesh.h"
#include "skitter/records.h"

namespace skitter::render {
Cull::Cull(const gpu::Context& context, float detail)
    : kernel_(context, {.name = "cull",
                        .code = {embedded::cull_comp_texel(), embedded::cull_comp_storage()},
                        .bindings = {{shared::DRAW_PICTURE, gpu::BindingKind::uniform},
                                     {shared::DRAW_BODY, gpu::BindingKind::load4},
                                     {shared::DRAW_INSTANCES, gpu::BindingKind::store},
                                     {shared::DRAW_COMMANDS, gpu::BindingKind::store}},
                        .pushBytes = sizeof(shared::CullConstants)}),
      detail_(detail) {}

CulledPage Cull::makePage(const gpu::Context& context, const gpu::Buffer& picture, const gpu::Buffer& bodies,
                          uint32_t agents, bool listsShown, bool looks) const {
  const int lists = looks ? shared::INSTANCE_LISTS : listsShown ? shared::FIRST_LOOK : shared::SHOWN;
  CulledPage page;
  page.agents = agents;
  page.listsShown = listsShown;
  page.instances = gpu::Buffer(context, uint64_t(agents) * uint64_t(lists) * sizeof(uint32_t),
                               "visible agents", gpu::BufferUse::vertex);
  page.commands = gpu::Buffer(context, shared::INSTANCE_LISTS * sizeof(VkDrawIndexedIndirectCommand),
                              "agent draws", gpu::BufferUse::indirect);
  page.bindings = kernel_.bind(context, {{shared::DRAW_PICTURE, &picture},
                                         {shared::DRAW_BODY, &bodies},
                                         {shared::DRAW_INSTANCES, &page.instances},
                                         {shared::DRAW_COMMANDS, &page.commands}});
  return page;
}

void Cull::record(vk::CommandBuffer cmd, const CulledPage& page, float radius, bool splats) const {
  shared::CullConstants constants{.agents = page.agents,
                                  .radius = radius,
                                  .lodPixels = {},
                                  .contactPixels = kContactPixels / detail_,
                                  .splatPixels = splats ? kSplatPixels / detail_ : 0,
                                  .shadePixels = splats ? kShadePixels / detail_ : 0,
                                  .listsShown = page.listsShown};
  std::ranges::transform(kLodPixels, constants.lodPixels, [&](float pixels) { return pixels / detail_; });
  kernel_.dispatch(cmd, page.bindings, gpu::bytesOf(constants),
                   gpu::groupsFor(page.agents, shared::WORK_GROUP));
}

}  // namespace skitter::render

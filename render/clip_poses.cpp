#include "render/clip_poses.h"

#include <bit>

#include "crowd/page.h"
#include "embedded/pose_clips_at_rates_comp_storage.h"
#include "embedded/pose_clips_at_rates_comp_texel.h"
#include "embedded/pose_clips_comp_storage.h"
#include "embedded/pose_clips_comp_texel.h"
#include "render/bindings.h"
#include "shared/bindings.h"
#include "skitter/records.h"

namespace skitter::render {

using gpu::BindingKind;

ClipPoses::ClipPoses(const gpu::Context& context, const crowd::Kind& kind, bool atRates)
    : atRates_(atRates), joints_(kind.clips.joints) {
  gpu::KernelInfo info{.name = "pose clips",
                       .code = {embedded::pose_clips_comp_texel(), embedded::pose_clips_comp_storage()},
                       .bindings = {{shared::DRAW_BODY, BindingKind::load4},
                                    {shared::DRAW_PLAY, BindingKind::load4},
                                    {shared::DRAW_CLIP_ROWS, BindingKind::load4},
                                    {shared::DRAW_SHOWN_POSE_OUT, BindingKind::store},
                                    {shared::DRAW_INSTANCES, BindingKind::store},
                                    {shared::DRAW_COMMANDS, BindingKind::store}},
                       .pushBytes = sizeof(shared::ClipPoseConstants),
                       .constants = {{shared::CONSTANT_JOINTS, joints_}}};
  if (atRates) {
    info.code = {embedded::pose_clips_at_rates_comp_texel(), embedded::pose_clips_at_rates_comp_storage()};
    for (const int binding :
         {shared::DRAW_CLIPS, shared::DRAW_CLIP_FRAMES, shared::DRAW_RATE, shared::DRAW_SHOWN_BODY})
      info.bindings.push_back({uint32_t(binding), BindingKind::load4});
    info.bindings.push_back({shared::DRAW_SHOWN_BODY_OUT, BindingKind::store});
    info.constants.emplace_back(shared::CONSTANT_SEARCH_STEPS,
                                int(std::bit_width(uint32_t(kind.clips.frames))));
  }
  kernel_ = gpu::Kernel(context, info);
}

gpu::Buffer ClipPoses::makePoses(const gpu::Context& context, uint32_t agents) const {
  return {context, uint64_t(agents) * uint64_t(joints_ * shared::MATRIX_STRIDE) * sizeof(glm::vec4),
          "poses of clips"};
}

gpu::Bindings ClipPoses::bind(const gpu::Context& context, const crowd::Kind& kind, const crowd::Page& page,
                              const gpu::Buffer& shownBody, const CulledPage& culled,
                              const gpu::Buffer& poses) const {
  std::vector<gpu::Binding> list{{shared::DRAW_BODY, &page.body},
                                 {shared::DRAW_PLAY, &page.play},
                                 {shared::DRAW_CLIP_ROWS, &kind.clipRows},
                                 {shared::DRAW_SHOWN_POSE_OUT, &poses},
                                 {shared::DRAW_INSTANCES, &culled.instances},
                                 {shared::DRAW_COMMANDS, &culled.commands}};
  if (atRates_) {
    list.push_back({shared::DRAW_CLIPS, &kind.clipHeads});
    list.push_back({shared::DRAW_CLIP_FRAMES, &kind.clipTimes});
    list.push_back({shared::DRAW_RATE, &page.rate});
    list.push_back({shared::DRAW_SHOWN_BODY, &shownBody});
    list.push_back({shared::DRAW_SHOWN_BODY_OUT, &shownBody});
  }
  return kernel_.bind(context, list);
}

void ClipPoses::record(vk::CommandBuffer cmd, const gpu::Bindings& page, const crowd::Kind& kind,
                       const CulledPage& culled, uint64_t tick) const {
  const shared::ClipPoseConstants constants{.agents = culled.agents,
                                            .tick = float(tick),
                                            .dt = kind.parameters.dt,
                                            .fade = kind.parameters.clipFade};
  kernel_.dispatchIndirect(cmd, page, gpu::bytesOf(constants), culled.commands, groupsOffset(shared::SHOWN));
}

}  // namespace skitter::render

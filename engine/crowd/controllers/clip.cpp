#include <bit>

#include "crowd/controllers/controllers.h"
#include "shared/bindings.h"

namespace skitter::crowd {

void loadClips(const gpu::Context& context, const skitter::Herd& from, const Rig& loaded, Kind& kind) {
  kind.clipSet = clipSetOf(from, loaded, kind.size);
  kind.clips = clipRecords(kind.clipSet, clipNames(from), kind.bones);
  for (Clip& clip : kind.clipSet.clips) clip.rows = {};
  kind.clipHeads = constantBuffer(context, kind.clips.heads, "clips");
  kind.clipTimes = constantBuffer(context, kind.clips.times, "clip frames");
  kind.clipRows = constantBuffer(context, kind.clips.rows, "clip rows");
  kind.clipLegs = constantBuffer(context, kind.clips.legs, "clip legs");
  kind.clipBones = constantBuffer(context, kind.clips.bones, "clip joints");
}

void addClips(const Kind& kind, gpu::KernelInfo& info) {
  using namespace shared;
  info.constants.emplace_back(CONSTANT_CLIPS, kind.clips.clips);
  info.constants.emplace_back(CONSTANT_JOINTS, kind.clips.joints);
  info.constants.emplace_back(CONSTANT_SEARCH_STEPS,
                              static_cast<int>(std::bit_width(static_cast<uint32_t>(kind.clips.frames))));
}

// Plays animations.
const ControllerStages clipController = {
    .all =
        [](const CrowdOptions& options) {
          std::vector stages{navigateStage(), avoidStage(), wakeStage(), blindBodyStage(), clipStage()};
          // For controller clip, only measure, footfalls and the host read feet.
          if (keepsFeet(options)) stages.push_back(clipSwingStage());
          for (const Stage& stage : {clipPoseStage(), measureStage(), footfallStage()})
            stages.push_back(stage);
          return stages;
        },
    .specialise = addClips,
    .prepare = loadClips,
};

}  // namespace skitter::crowd

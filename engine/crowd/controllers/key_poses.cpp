#include "crowd/controllers/controllers.h"

namespace skitter::crowd {
namespace {

void prepareKeyPoses(const gpu::Context& context, const skitter::Herd& from, const Rig& loaded, Kind& kind) {
  kind.keyPoses =
      keyPoses(clipSetOf(from, loaded, kind.size), clipNames(from), from.keys, kind.rig, kind.rigRecords);
  kind.keyBuffer = constantBuffer(context, kind.keyPoses.records, "key poses");
}

}  // namespace

// Joins a few key poses of an animation.
const ControllerStages keyPosesController = {
    .all =
        [](const CrowdOptions&) {
          return std::vector{navigateStage(),  avoidStage(),       wakeStage(),
                             blindBodyStage(), keyPoseGaitStage(), keyPoseSwingStage(),
                             poseStage(),      measureStage(),     footfallStage()};
        },
    .prepare = prepareKeyPoses,
};

}  // namespace skitter::crowd

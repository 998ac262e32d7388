#include "crowd/controllers/controllers.h"

namespace skitter::crowd {

// Each foot runs on a fixed loop.
const ControllerStages loopController = {
    .all =
        [](const CrowdOptions&) {
          return std::vector{navigateStage(),  avoidStage(), wakeStage(), blindBodyStage(), loopGaitStage(),
                             loopSwingStage(), ikStage(),    poseStage(), measureStage(),   footfallStage()};
        },
};

}  // namespace skitter::crowd

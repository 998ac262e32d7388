#include <fmt/format.h>

#include "crowd/controllers/controllers.h"
#include "skitter/error.h"

namespace skitter::crowd {
namespace {

void preparePlanted(const gpu::Context& context, const skitter::Herd& from, const Rig& loaded, Kind& kind) {
  if (from.solver != Solver::activeSet)
    throw inputError(fmt::format("a herd's solver is {}, expected {}: its controller is {}",
                                 nameOf(from.solver), nameOf(Solver::activeSet), nameOf(from.controller)));
  loadClips(context, from, loaded, kind);
}

}  // namespace

// Plays animations, and puts their feet on the ground.
const ControllerStages plantedController = {
    .all =
        [](const CrowdOptions&) {
          return std::vector{navigateStage(), avoidStage(),        wakeStage(),      blindBodyStage(),
                             clipStage(),     plantedSwingStage(), plantedIkStage(), plantedPoseStage(),
                             measureStage(),  footfallStage()};
        },
    .specialise = addClips,
    .prepare = preparePlanted,
};

}  // namespace skitter::crowd

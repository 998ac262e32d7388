#include <fmt/format.h>

#include "crowd/controllers/controllers.h"
#include "skitter/error.h"
#include "skitter/records.h"

namespace skitter::crowd {
namespace {

// Metres, so that nobody goes half of STEP_TILES tiles while a foot stands.
constexpr float longestLeg = 100;

void prepareGait(const gpu::Context&, const skitter::Herd& from, const Rig&, Kind& kind) {
  if (kind.rig.legLength > longestLeg)
    throw inputError(fmt::format("{}: legs of {:.4g} m, expected at most {:.4g} m: scale the rig down",
                                 kind.rig.name, kind.rig.legLength, longestLeg));
  kind.reachTriggered = from.stepping == Stepping::reach;
}

void checkTick(const Kind& kind, float dt) {
  const float ticks = (kind.hurts ? shared::LAME_SLOWNESS : 1.0f) * kind.parameters.swingStill / dt;
  if (!(ticks < shared::MOST_STEP_TICKS))
    throw inputError(
        fmt::format("dt {:.3g} s: a step of {} would last {:.0f} ticks, expected fewer than {:.0f}", dt,
                    kind.rig.name, ticks, shared::MOST_STEP_TICKS));
}

}  // namespace

// Feet step to footholds that are chosen on the ground.
const ControllerStages adaptiveController = {
    .all =
        [](const CrowdOptions&) {
          return std::vector{navigateStage(), avoidStage(),   wakeStage(),     adaptStage(), reactStage(),
                             bodyStage(),     gaitStage(),    footholdStage(), swingStage(), ikStage(),
                             poseStage(),     measureStage(), footfallStage()};
        },
    .fused =
        [] {
          return std::vector{navigateBodyAndGaitStage(), bodyAndGaitStage(), swingAndIkStage()};
        },
    .prepare = prepareGait,
    .checkTick = checkTick,
};

}  // namespace skitter::crowd

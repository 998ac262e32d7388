#include "crowd/stage.h"

#include <cstring>

#include "crowd/herd.h"
#include "crowd/tuning.h"
#include "shared/bindings.h"
#include "shared/ik_batch.h"

namespace skitter::crowd {

const std::vector<Stage>& stages() {
  static const std::vector<Stage> list = {
      navigateStage(), bodyStage(), gaitStage(), footholdStage(),
      swingStage(),    ikStage(),   poseStage(), measureStage(),
  };
  return list;
}
void makeKernels(const gpu::Context& context, const CrowdOptions& options, Herd& herd) {
  using namespace shared;
  for (const Stage& stage : stages()) {
    gpu::KernelInfo info{stage.name, stage.code, stage.bindings, sizeof(TickConstants)};
    const bool isIk = std::strcmp(stage.name, "ik") == 0;
    if (isIk && herd.ik.solver != SOLVER_FABRIK) info.code = comparedIkCode();
    for (const StageShader& other : options.shaders)
      if (other.stage == stage.name) info.code = {other.texel, other.storage};
    info.constants = {
        {CONSTANT_LEGS, herd.legs}, {CONSTANT_BONES, herd.bones}, {CONSTANT_GROUPS, herd.groups}};
    if (isIk) {
      info.constants.emplace_back(CONSTANT_APPROACH_ITERATIONS, herd.ik.approach);
      info.constants.emplace_back(CONSTANT_POLISH_ITERATIONS, herd.ik.polish);
      info.constants.emplace_back(CONSTANT_SOLVER, herd.ik.solver);
    }
    herd.kernels.emplace_back(context, info);
  }
}

}  // namespace skitter::crowd

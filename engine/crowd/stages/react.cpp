#include "crowd/herd.h"
#include "crowd/stage.h"
#include "embedded/react_comp_storage.h"
#include "embedded/react_comp_texel.h"
#include "shared/bindings.h"

namespace skitter::crowd {
namespace {

void specialiseReact(const StageNeeds& needs, StageKernels& kernels) {
  addRigLegs(needs.kind, kernels.first);
  kernels.afterEdit = kernels.first;
  kernels.afterEdit->constants.emplace_back(shared::CONSTANT_WATCH, 1);
}

}  // namespace

Stage reactStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return {StageId::react,
          {embedded::react_comp_texel(), embedded::react_comp_storage()},
          {{BINDING_PARAMETERS, uniform},
           {BINDING_HEIGHTS, heights},
           {BINDING_BODY, load4},
           {BINDING_GAIT, load4},
           {BINDING_STEP, load4},
           {BINDING_MISS, load4},
           {BINDING_HURT, load4},
           {BINDING_PUSH, load4},
           {BINDING_CARRIED, load4},
           {BINDING_REACTION, load4},
           {BINDING_REACTION_OUT, store}},
          Stage::Over::agents,
          specialiseReact};
}

}  // namespace skitter::crowd

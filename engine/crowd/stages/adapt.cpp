#include "crowd/herd.h"
#include "crowd/stage.h"
#include "embedded/adapt_comp_storage.h"
#include "embedded/adapt_comp_texel.h"
#include "shared/bindings.h"

namespace skitter::crowd {
namespace {

void specialiseAdapt(const StageNeeds& needs, StageKernels& kernels) {
  kernels.first.constants.emplace_back(shared::CONSTANT_CANDIDATES,
                                       static_cast<int>(needs.kind.gaitMap.candidates));
}

}  // namespace

Stage adaptStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return {StageId::adapt,
          {embedded::adapt_comp_texel(), embedded::adapt_comp_storage()},
          {{BINDING_PARAMETERS, uniform},
           {BINDING_STEER, load4},
           {BINDING_BODY, load4},
           {BINDING_FOOT, load4},
           {BINDING_TIP, load4},
           {BINDING_GAIT_MAP, load4},
           {BINDING_HURT, load4},
           {BINDING_HURT_OUT, store},
           {BINDING_SEARCH, load4},
           {BINDING_SEARCH_OUT, store}},
          Stage::Over::agents,
          specialiseAdapt};
}

}  // namespace skitter::crowd

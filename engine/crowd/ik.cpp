#include "crowd/stage.h"
#include "embedded/ik_comp_storage.h"
#include "embedded/ik_comp_texel.h"
#include "embedded/ik_compared_comp_storage.h"
#include "embedded/ik_compared_comp_texel.h"
#include "embedded/ik_planted_comp_storage.h"
#include "embedded/ik_planted_comp_texel.h"
#include "embedded/swing_ik_comp_storage.h"
#include "embedded/swing_ik_comp_texel.h"
#include "embedded/swing_ik_compared_comp_storage.h"
#include "embedded/swing_ik_compared_comp_texel.h"
#include "shared/bindings.h"
#include "shared/records.h"

namespace skitter::crowd {

Stage ikStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return {"ik",
          {embedded::ik_comp_texel(), embedded::ik_comp_storage()},
          {{BINDING_PARAMETERS, uniform},
           {BINDING_RIG, load4},
           {BINDING_BODY, load4},
           {BINDING_FOOT, load4},
           {BINDING_CHAIN, load4},
           {BINDING_CHAIN_OUT, store},
           {BINDING_MISS_OUT, store},
           {BINDING_TIP_OUT, store},
           {BINDING_LIST, store},
           {BINDING_COUNTERS, store}},
          Stage::Over::legs,
          COUNTER_IK_DISPATCH_X};
}

Stage swingAndIkStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return {"swing+ik",
          {embedded::swing_ik_comp_texel(), embedded::swing_ik_comp_storage()},
          {{BINDING_PARAMETERS, uniform},
           {BINDING_RIG, load4},
           {BINDING_BODY, load4},
           {BINDING_STEP, load4},
           {BINDING_ARC, load4},
           {BINDING_FOOT_OUT, store},
           {BINDING_CHAIN, load4},
           {BINDING_CHAIN_OUT, store},
           {BINDING_MISS_OUT, store},
           {BINDING_TIP_OUT, store},
           {BINDING_LIST, store},
           {BINDING_COUNTERS, store}},
          Stage::Over::legs,
          COUNTER_IK_DISPATCH_X};
}

Stage plantedIkStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return {"ik",
          {embedded::ik_planted_comp_texel(), embedded::ik_planted_comp_storage()},
          {{BINDING_PARAMETERS, uniform},
           {BINDING_RIG, load4},
           {BINDING_BODY, load4},
           {BINDING_FOOT, load4},
           {BINDING_START, load4},
           {BINDING_CHAIN_OUT, store},
           {BINDING_TIP_OUT, store},
           {BINDING_FIX_OUT, store},
           {BINDING_LIST, store},
           {BINDING_COUNTERS, store}},
          Stage::Over::legs,
          COUNTER_IK_DISPATCH_X};
}

gpu::ShaderCode comparedIkCode(bool withSwing) {
  if (withSwing)
    return {embedded::swing_ik_compared_comp_texel(), embedded::swing_ik_compared_comp_storage()};
  return {embedded::ik_compared_comp_texel(), embedded::ik_compared_comp_storage()};
}

}  // namespace skitter::crowd

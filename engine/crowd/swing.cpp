#include "crowd/stage.h"
#include "embedded/swing_comp_storage.h"
#include "embedded/swing_comp_texel.h"
#include "shared/bindings.h"

namespace skitter::crowd {

Stage swingStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return {"swing",
          {embedded::swing_comp_texel(), embedded::swing_comp_storage()},
          {{BINDING_PARAMETERS, uniform},
           {BINDING_BODY, load4},
           {BINDING_STEP, load4},
           {BINDING_FOOT_OUT, store}},
          Stage::Over::legs};
}

}  // namespace skitter::crowd

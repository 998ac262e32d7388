#include "crowd/stage.h"
#include "embedded/pose_comp_storage.h"
#include "embedded/pose_comp_texel.h"
#include "shared/bindings.h"

namespace skitter::crowd {

Stage poseStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return {"pose",
          {embedded::pose_comp_texel(), embedded::pose_comp_storage()},
          {{BINDING_PARAMETERS, uniform},
           {BINDING_RIG, load4},
           {BINDING_BODY, load4},
           {BINDING_CHAIN, load4},
           {BINDING_POSE_OUT, store}},
          Stage::Over::legs};
}

}  // namespace skitter::crowd

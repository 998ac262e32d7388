#include "crowd/herd.h"
#include "crowd/stage.h"
#include "embedded/body_blind_comp_storage.h"
#include "embedded/body_blind_comp_texel.h"
#include "embedded/body_blind_hurt_comp_storage.h"
#include "embedded/body_blind_hurt_comp_texel.h"
#include "embedded/body_comp_storage.h"
#include "embedded/body_comp_texel.h"
#include "embedded/body_hurt_comp_storage.h"
#include "embedded/body_hurt_comp_texel.h"
#include "embedded/body_react_comp_storage.h"
#include "embedded/body_react_comp_texel.h"
#include "shared/bindings.h"

namespace skitter::crowd {
namespace {

void specialiseBody(const StageNeeds& needs, StageKernels& kernels) { addRigLegs(needs.kind, kernels.first); }

}  // namespace

Stage bodyStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return withReact(withHurt(Stage{StageId::body,
                                  {embedded::body_comp_texel(), embedded::body_comp_storage()},
                                  {{BINDING_PARAMETERS, uniform},
                                   {BINDING_HEIGHTS, heights},
                                   {BINDING_STEER, load4},
                                   {BINDING_GAIT, load4},
                                   {BINDING_STEP, load4},
                                   {BINDING_MISS, load4},
                                   {BINDING_BODY, load4},
                                   {BINDING_BODY_OUT, store}},
                                  Stage::Over::agents,
                                  specialiseBody},
                            {embedded::body_hurt_comp_texel(), embedded::body_hurt_comp_storage()}),
                   {embedded::body_react_comp_texel(), embedded::body_react_comp_storage()});
}

Stage blindBodyStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return withHurt(Stage{StageId::body,
                        {embedded::body_blind_comp_texel(), embedded::body_blind_comp_storage()},
                        {{BINDING_PARAMETERS, uniform},
                         {BINDING_HEIGHTS, heights},
                         {BINDING_STEER, load4},
                         {BINDING_BODY, load4},
                         {BINDING_BODY_OUT, store}},
                        Stage::Over::agents,
                        specialiseBody},
                  {embedded::body_blind_hurt_comp_texel(), embedded::body_blind_hurt_comp_storage()});
}

}  // namespace skitter::crowd

#include "crowd/stage.h"
#include "embedded/foothold_among_comp_storage.h"
#include "embedded/foothold_among_comp_texel.h"
#include "embedded/foothold_among_hurt_comp_storage.h"
#include "embedded/foothold_among_hurt_comp_texel.h"
#include "embedded/foothold_among_react_comp_storage.h"
#include "embedded/foothold_among_react_comp_texel.h"
#include "embedded/foothold_comp_storage.h"
#include "embedded/foothold_comp_texel.h"
#include "embedded/foothold_hurt_comp_storage.h"
#include "embedded/foothold_hurt_comp_texel.h"
#include "embedded/foothold_react_comp_storage.h"
#include "embedded/foothold_react_comp_texel.h"
#include "shared/bindings.h"

namespace skitter::crowd {

Stage footholdStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return withReact(withHurt(Stage{StageId::foothold,
                                  {embedded::foothold_comp_texel(), embedded::foothold_comp_storage()},
                                  {{BINDING_PARAMETERS, uniform},
                                   {BINDING_HEIGHTS, heights},
                                   {BINDING_RIG, load4},
                                   {BINDING_BODY, load4},
                                   {BINDING_GAIT, load4},
                                   {BINDING_STEP, load4},
                                   {BINDING_STEP_OUT, store},
                                   {BINDING_ARC, load4},
                                   {BINDING_ARC_OUT, store},
                                   {BINDING_LIST, store},
                                   {BINDING_COUNTERS, store}},
                                  Stage::Over::listed},
                            {embedded::foothold_hurt_comp_texel(), embedded::foothold_hurt_comp_storage()},
                            {{BINDING_CHAIN, load4}}),
                   {embedded::foothold_react_comp_texel(), embedded::foothold_react_comp_storage()});
}

Stage amongFootholdStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  Stage stage = footholdStage();
  stage.code = {embedded::foothold_among_comp_texel(), embedded::foothold_among_comp_storage()};
  stage.hurtCode = {embedded::foothold_among_hurt_comp_texel(), embedded::foothold_among_hurt_comp_storage()};
  stage.reactCode = {embedded::foothold_among_react_comp_texel(),
                     embedded::foothold_among_react_comp_storage()};
  stage.seesCrowd = true;
  for (const int binding : {BINDING_CELL, BINDING_PLACE, BINDING_WALKER})
    stage.bindings.push_back({static_cast<uint32_t>(binding), load4});
  return stage;
}

}  // namespace skitter::crowd

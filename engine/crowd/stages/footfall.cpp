#include "crowd/stage.h"
#include "embedded/footfall_comp_storage.h"
#include "embedded/footfall_comp_texel.h"
#include "embedded/footfall_listed_comp_storage.h"
#include "embedded/footfall_listed_comp_texel.h"
#include "shared/bindings.h"

namespace skitter::crowd {

Stage footfallStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  Stage stage{StageId::footfall,
              {embedded::footfall_comp_texel(), embedded::footfall_comp_storage()},
              {{BINDING_PARAMETERS, uniform},
               {BINDING_COUNTERS, store},
               {BINDING_BODY, load4},
               {BINDING_FOOT, load4},
               {BINDING_TIP, load4},
               {BINDING_FLIGHT, load4},
               {BINDING_FLIGHT_OUT, store},
               {BINDING_FOOTFALL_OUT, store}},
              Stage::Over::everyLeg};
  stage.levelCode = {embedded::footfall_listed_comp_texel(), embedded::footfall_listed_comp_storage()};
  return stage;
}

}  // namespace skitter::crowd

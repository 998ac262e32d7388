#include "crowd/stage.h"
#include "embedded/measure_comp_storage.h"
#include "embedded/measure_comp_texel.h"
#include "embedded/measure_hurt_comp_storage.h"
#include "embedded/measure_hurt_comp_texel.h"
#include "shared/bindings.h"

namespace skitter::crowd {

Stage measureStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return withHurt(Stage{StageId::measure,
                        {embedded::measure_comp_texel(), embedded::measure_comp_storage()},
                        {{BINDING_PARAMETERS, uniform},
                         {BINDING_HEIGHTS, heights},
                         {BINDING_RIG, load4},
                         {BINDING_BODY, load4},
                         {BINDING_FOOT, load4},
                         {BINDING_CHAIN, load4},
                         {BINDING_TIP, load4},
                         {BINDING_WATCH, load4},
                         {BINDING_WATCH_OUT, store},
                         {BINDING_METRIC, load4},
                         {BINDING_METRIC_OUT, store},
                         {BINDING_COUNTERS, store},
                         {BINDING_HISTOGRAM, store}},
                        Stage::Over::watched},
                  {embedded::measure_hurt_comp_texel(), embedded::measure_hurt_comp_storage()},
                  {{BINDING_CARRIED, load4}});
}

}  // namespace skitter::crowd

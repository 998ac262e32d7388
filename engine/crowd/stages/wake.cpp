#include "crowd/stage.h"
#include "embedded/wake_comp_storage.h"
#include "embedded/wake_comp_texel.h"
#include "embedded/wake_levels_comp_storage.h"
#include "embedded/wake_levels_comp_texel.h"
#include "embedded/wake_levels_react_comp_storage.h"
#include "embedded/wake_levels_react_comp_texel.h"
#include "shared/bindings.h"

namespace skitter::crowd {

Stage wakeStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return {StageId::wake,
          {embedded::wake_comp_texel(), embedded::wake_comp_storage()},
          {{BINDING_STEER, load4}, {BINDING_AWAKE_OUT, store}, {BINDING_COUNTERS, store}},
          Stage::Over::blocks};
}

Stage levelWakeStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return {StageId::wake,
          {embedded::wake_levels_comp_texel(), embedded::wake_levels_comp_storage()},
          {{BINDING_BODY, load4},
           {BINDING_RATE, load4},
           {BINDING_RATE_OUT, store},
           {BINDING_AWAKE_OUT, store},
           {BINDING_COUNTERS, store},
           {BINDING_LEVELS, store}},
          Stage::Over::blocks};
}

Stage reactLevelWakeStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  Stage stage = levelWakeStage();
  stage.code = {embedded::wake_levels_react_comp_texel(), embedded::wake_levels_react_comp_storage()};
  const std::initializer_list<gpu::BindingDecl> more{{BINDING_PARAMETERS, uniform},
                                                     {BINDING_PUSH, load4},
                                                     {BINDING_CARRIED, load4},
                                                     {BINDING_REACTION, load4},
                                                     {BINDING_REACTION_OUT, store}};
  stage.bindings.insert(stage.bindings.end(), more);
  return stage;
}

}  // namespace skitter::crowd

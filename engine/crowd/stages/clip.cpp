#include "crowd/stage.h"
#include "embedded/clip_comp_storage.h"
#include "embedded/clip_comp_texel.h"
#include "shared/bindings.h"

namespace skitter::crowd {

Stage clipStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return {StageId::clip,
          {embedded::clip_comp_texel(), embedded::clip_comp_storage()},
          {{BINDING_PARAMETERS, uniform},
           {BINDING_BODY, load4},
           {BINDING_PLAY, load4},
           {BINDING_PLAY_OUT, store},
           {BINDING_CLIP, load4},
           {BINDING_CLIP_FRAME, load4},
           {BINDING_LIST, store},
           {BINDING_COUNTERS, store}},
          Stage::Over::agents};
}

}  // namespace skitter::crowd

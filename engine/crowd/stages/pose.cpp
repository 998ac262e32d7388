#include "crowd/stage.h"
#include "embedded/pose_clip_comp_storage.h"
#include "embedded/pose_clip_comp_texel.h"
#include "embedded/pose_comp_storage.h"
#include "embedded/pose_comp_texel.h"
#include "embedded/pose_hurt_comp_storage.h"
#include "embedded/pose_hurt_comp_texel.h"
#include "embedded/pose_planted_comp_storage.h"
#include "embedded/pose_planted_comp_texel.h"
#include "embedded/pose_planted_hurt_comp_storage.h"
#include "embedded/pose_planted_hurt_comp_texel.h"
#include "shared/bindings.h"
#include "skitter/records.h"

namespace skitter::crowd {

Stage poseStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return withHurt(Stage{StageId::pose,
                        {embedded::pose_comp_texel(), embedded::pose_comp_storage()},
                        {{BINDING_PARAMETERS, uniform},
                         {BINDING_RIG, load4},
                         {BINDING_BODY, load4},
                         {BINDING_CHAIN, load4},
                         {BINDING_POSE_OUT, store}},
                        Stage::Over::legs},
                  {embedded::pose_hurt_comp_texel(), embedded::pose_hurt_comp_storage()});
}

Stage clipPoseStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return {StageId::pose,
          {embedded::pose_clip_comp_texel(), embedded::pose_clip_comp_storage()},
          {{BINDING_PARAMETERS, uniform},
           {BINDING_BODY, load4},
           {BINDING_PLAY, load4},
           {BINDING_CLIP_ROW, load4},
           {BINDING_LIST, store},
           {BINDING_COUNTERS, store},
           {BINDING_POSE_OUT, store}},
          Stage::Over::joints,
          [](const StageNeeds&, StageKernels& kernels) { addListed(kernels); },
          COUNTER_DISPATCH_X};
}

Stage plantedPoseStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return withHurt(Stage{StageId::pose,
                        {embedded::pose_planted_comp_texel(), embedded::pose_planted_comp_storage()},
                        {{BINDING_PARAMETERS, uniform},
                         {BINDING_BODY, load4},
                         {BINDING_PLAY, load4},
                         {BINDING_CLIP_ROW, load4},
                         {BINDING_CLIP_JOINT, load4},
                         {BINDING_FIX, load4},
                         {BINDING_LIST, store},
                         {BINDING_COUNTERS, store},
                         {BINDING_POSE_OUT, store}},
                        Stage::Over::joints},
                  {embedded::pose_planted_hurt_comp_texel(), embedded::pose_planted_hurt_comp_storage()},
                  {{BINDING_CLIP_LEG, load4}});
}

}  // namespace skitter::crowd

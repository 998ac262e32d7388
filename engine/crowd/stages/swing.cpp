#include "crowd/stage.h"
#include "embedded/swing_clip_comp_storage.h"
#include "embedded/swing_clip_comp_texel.h"
#include "embedded/swing_comp_storage.h"
#include "embedded/swing_comp_texel.h"
#include "embedded/swing_hurt_comp_storage.h"
#include "embedded/swing_hurt_comp_texel.h"
#include "embedded/swing_key_poses_comp_storage.h"
#include "embedded/swing_key_poses_comp_texel.h"
#include "embedded/swing_loop_comp_storage.h"
#include "embedded/swing_loop_comp_texel.h"
#include "embedded/swing_loop_hurt_comp_storage.h"
#include "embedded/swing_loop_hurt_comp_texel.h"
#include "embedded/swing_planted_comp_storage.h"
#include "embedded/swing_planted_comp_texel.h"
#include "embedded/swing_planted_hurt_comp_storage.h"
#include "embedded/swing_planted_hurt_comp_texel.h"
#include "embedded/swing_react_comp_storage.h"
#include "embedded/swing_react_comp_texel.h"
#include "shared/bindings.h"

namespace skitter::crowd {
namespace {

void addFeet(const StageNeeds& needs, StageKernels& kernels) {
  kernels.first.constants.emplace_back(shared::CONSTANT_FEET, keepsFeet(needs.options));
}

}  // namespace

Stage swingStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return withReact(withHurt(Stage{StageId::swing,
                                  {embedded::swing_comp_texel(), embedded::swing_comp_storage()},
                                  {{BINDING_PARAMETERS, uniform},
                                   {BINDING_BODY, load4},
                                   {BINDING_STEP, load4},
                                   {BINDING_ARC, load4},
                                   {BINDING_FOOT_OUT, store}},
                                  Stage::Over::legs},
                            {embedded::swing_hurt_comp_texel(), embedded::swing_hurt_comp_storage()}),
                   {embedded::swing_react_comp_texel(), embedded::swing_react_comp_storage()},
                   {{BINDING_RIG, load4}, {BINDING_HEIGHTS, heights}});
}

Stage loopSwingStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return withHurt(Stage{StageId::swing,
                        {embedded::swing_loop_comp_texel(), embedded::swing_loop_comp_storage()},
                        {{BINDING_PARAMETERS, uniform},
                         {BINDING_RIG, load4},
                         {BINDING_BODY, load4},
                         {BINDING_GAIT, load4},
                         {BINDING_FOOT_OUT, store}},
                        Stage::Over::legs},
                  {embedded::swing_loop_hurt_comp_texel(), embedded::swing_loop_hurt_comp_storage()});
}

Stage clipSwingStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return {StageId::swing,
          {embedded::swing_clip_comp_texel(), embedded::swing_clip_comp_storage()},
          {{BINDING_PARAMETERS, uniform},
           {BINDING_RIG, load4},
           {BINDING_BODY, load4},
           {BINDING_PLAY, load4},
           {BINDING_CLIP_FRAME, load4},
           {BINDING_CLIP_ROW, load4},
           {BINDING_CLIP_LEG, load4},
           {BINDING_FOOT_OUT, store},
           {BINDING_CHAIN_OUT, store},
           {BINDING_TIP_OUT, store}},
          Stage::Over::legs};
}

Stage plantedSwingStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return withHurt(Stage{StageId::swing,
                        {embedded::swing_planted_comp_texel(), embedded::swing_planted_comp_storage()},
                        {{BINDING_PARAMETERS, uniform},
                         {BINDING_HEIGHTS, heights},
                         {BINDING_RIG, load4},
                         {BINDING_BODY, load4},
                         {BINDING_STEP, load4},
                         {BINDING_STEP_OUT, store},
                         {BINDING_PLAY, load4},
                         {BINDING_CLIP_FRAME, load4},
                         {BINDING_CLIP_ROW, load4},
                         {BINDING_CLIP_LEG, load4},
                         {BINDING_FOOT_OUT, store},
                         {BINDING_START_OUT, store}},
                        Stage::Over::legs},
                  {embedded::swing_planted_hurt_comp_texel(), embedded::swing_planted_hurt_comp_storage()});
}

Stage keyPoseSwingStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return {StageId::swing,
          {embedded::swing_key_poses_comp_texel(), embedded::swing_key_poses_comp_storage()},
          {{BINDING_PARAMETERS, uniform},
           {BINDING_RIG, load4},
           {BINDING_BODY, load4},
           {BINDING_GAIT, load4},
           {BINDING_KEY, load4},
           {BINDING_CHAIN, load4},
           {BINDING_SPRING, load4},
           {BINDING_FOOT_OUT, store},
           {BINDING_CHAIN_OUT, store},
           {BINDING_SPRING_OUT, store},
           {BINDING_TIP_OUT, store}},
          Stage::Over::legs,
          addFeet};
}

}  // namespace skitter::crowd

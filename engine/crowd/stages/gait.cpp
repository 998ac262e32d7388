#include "crowd/herd.h"
#include "crowd/stage.h"
#include "embedded/body_gait_comp_storage.h"
#include "embedded/body_gait_comp_texel.h"
#include "embedded/body_gait_hurt_comp_storage.h"
#include "embedded/body_gait_hurt_comp_texel.h"
#include "embedded/body_gait_react_comp_storage.h"
#include "embedded/body_gait_react_comp_texel.h"
#include "embedded/gait_comp_storage.h"
#include "embedded/gait_comp_texel.h"
#include "embedded/gait_hurt_comp_storage.h"
#include "embedded/gait_hurt_comp_texel.h"
#include "embedded/gait_key_poses_comp_storage.h"
#include "embedded/gait_key_poses_comp_texel.h"
#include "embedded/gait_loop_comp_storage.h"
#include "embedded/gait_loop_comp_texel.h"
#include "embedded/gait_loop_hurt_comp_storage.h"
#include "embedded/gait_loop_hurt_comp_texel.h"
#include "embedded/gait_react_comp_storage.h"
#include "embedded/gait_react_comp_texel.h"
#include "embedded/navigate_body_gait_comp_storage.h"
#include "embedded/navigate_body_gait_comp_texel.h"
#include "embedded/navigate_body_gait_hurt_comp_storage.h"
#include "embedded/navigate_body_gait_hurt_comp_texel.h"
#include "shared/bindings.h"

namespace skitter::crowd {
namespace {

void specialiseGait(const StageNeeds& needs, StageKernels& kernels) {
  addRigLegs(needs.kind, kernels.first);
  kernels.first.constants.emplace_back(shared::CONSTANT_REACH, needs.kind.reachTriggered ? 1 : 0);
  kernels.afterEdit = kernels.first;
  kernels.afterEdit->constants.emplace_back(shared::CONSTANT_WATCH, 1);
}

}  // namespace

Stage gaitStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return withReact(withHurt(Stage{StageId::gait,
                                  {embedded::gait_comp_texel(), embedded::gait_comp_storage()},
                                  {{BINDING_PARAMETERS, uniform},
                                   {BINDING_HEIGHTS, heights},
                                   {BINDING_BODY, load4},
                                   {BINDING_STEP, load4},
                                   {BINDING_ARC, load4},
                                   {BINDING_MISS, load4},
                                   {BINDING_GAIT, load4},
                                   {BINDING_GAIT_OUT, store},
                                   {BINDING_LIST, store},
                                   {BINDING_COUNTERS, store}},
                                  Stage::Over::agents,
                                  specialiseGait},
                            {embedded::gait_hurt_comp_texel(), embedded::gait_hurt_comp_storage()}),
                   {embedded::gait_react_comp_texel(), embedded::gait_react_comp_storage()});
}

Stage bodyAndGaitStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return withReact(withHurt(Stage{{StageId::body, StageId::gait},
                                  {embedded::body_gait_comp_texel(), embedded::body_gait_comp_storage()},
                                  {{BINDING_PARAMETERS, uniform},
                                   {BINDING_HEIGHTS, heights},
                                   {BINDING_STEER, load4},
                                   {BINDING_STEP, load4},
                                   {BINDING_ARC, load4},
                                   {BINDING_MISS, load4},
                                   {BINDING_BODY, load4},
                                   {BINDING_BODY_OUT, store},
                                   {BINDING_GAIT, load4},
                                   {BINDING_GAIT_OUT, store},
                                   {BINDING_LIST, store},
                                   {BINDING_COUNTERS, store}},
                                  Stage::Over::agents,
                                  specialiseGait},
                            {embedded::body_gait_hurt_comp_texel(), embedded::body_gait_hurt_comp_storage()}),
                   {embedded::body_gait_react_comp_texel(), embedded::body_gait_react_comp_storage()});
}

Stage navigateBodyAndGaitStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  Stage stage = bodyAndGaitStage();
  stage.makes = {StageId::navigate, StageId::body, StageId::gait};
  stage.code = {embedded::navigate_body_gait_comp_texel(), embedded::navigate_body_gait_comp_storage()};
  stage.hurtCode = {embedded::navigate_body_gait_hurt_comp_texel(),
                    embedded::navigate_body_gait_hurt_comp_storage()};
  stage.reactCode.reset();  // react comes between navigate and body
  std::erase_if(stage.bindings, [](const gpu::BindingDecl& decl) { return decl.binding == BINDING_STEER; });
  stage.bindings.push_back({BINDING_GOAL, load4});
  stage.bindings.push_back({BINDING_GOAL_OUT, store});
  stage.bindings.push_back({BINDING_STEER_OUT, store});
  return stage;
}

Stage loopGaitStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return withHurt(Stage{StageId::gait,
                        {embedded::gait_loop_comp_texel(), embedded::gait_loop_comp_storage()},
                        {{BINDING_PARAMETERS, uniform},
                         {BINDING_BODY, load4},
                         {BINDING_GAIT, load4},
                         {BINDING_GAIT_OUT, store}},
                        Stage::Over::agents},
                  {embedded::gait_loop_hurt_comp_texel(), embedded::gait_loop_hurt_comp_storage()});
}

Stage keyPoseGaitStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return {StageId::gait,
          {embedded::gait_key_poses_comp_texel(), embedded::gait_key_poses_comp_storage()},
          {{BINDING_PARAMETERS, uniform},
           {BINDING_BODY, load4},
           {BINDING_GAIT, load4},
           {BINDING_GAIT_OUT, store}},
          Stage::Over::agents};
}

}  // namespace skitter::crowd

#include <algorithm>

#include "crowd/herd.h"
#include "crowd/stage.h"
#include "embedded/ik_comp_storage.h"
#include "embedded/ik_comp_texel.h"
#include "embedded/ik_compared_comp_storage.h"
#include "embedded/ik_compared_comp_texel.h"
#include "embedded/ik_hurt_comp_storage.h"
#include "embedded/ik_hurt_comp_texel.h"
#include "embedded/ik_planted_comp_storage.h"
#include "embedded/ik_planted_comp_texel.h"
#include "embedded/ik_planted_hurt_comp_storage.h"
#include "embedded/ik_planted_hurt_comp_texel.h"
#include "embedded/swing_ik_comp_storage.h"
#include "embedded/swing_ik_comp_texel.h"
#include "embedded/swing_ik_compared_comp_storage.h"
#include "embedded/swing_ik_compared_comp_texel.h"
#include "embedded/swing_ik_hurt_comp_storage.h"
#include "embedded/swing_ik_hurt_comp_texel.h"
#include "embedded/swing_ik_react_comp_storage.h"
#include "embedded/swing_ik_react_comp_texel.h"
#include "gpu/context.h"
#include "shared/bindings.h"
#include "shared/ik_batch.h"
#include "skitter/records.h"

namespace skitter::crowd {
namespace {

// Where the rig has fewer legs than there are constants of, its own follow each other again: equal ones need
// not be chosen from.
bool addRigBones(const Kind& kind, gpu::KernelInfo& info) {
  using namespace shared;
  if (kind.legs > CHOSEN_LEGS || kind.bones > CHOSEN_BONES) return false;
  for (int bone = 0; bone < kind.bones; ++bone)
    for (int i = 0; i < 4; ++i)
      for (int leg = 0; leg < CHOSEN_LEGS; ++leg) {
        const int at =
            4 * ((leg % kind.legs) * rigStride(kind.bones) + RIG_LEG_STRIDE + RIG_BONE_STRIDE * bone + 7) + i;
        info.constants.emplace_back(CONSTANT_RIG_BONES + (4 * bone + i) * CHOSEN_LEGS + leg,
                                    kind.rigRecords[static_cast<size_t>(at)]);
      }
  return true;
}

void specialiseSolve(const StageNeeds& needs, StageKernels& kernels) {
  using namespace shared;
  const Kind& kind = needs.kind;
  gpu::KernelInfo& info = kernels.first;
  const bool padded = std::ranges::any_of(
      kind.rig.legs, [&](const Leg& leg) { return static_cast<int>(leg.bones.size()) < kind.bones; });
  for (const gpu::SpecConstant& constant :
       {gpu::SpecConstant(CONSTANT_FEET, keepsFeet(needs.options)),
        gpu::SpecConstant(CONSTANT_APPROACH_ITERATIONS, kind.ik.approach),
        gpu::SpecConstant(CONSTANT_POLISH_ITERATIONS, kind.ik.polish),
        gpu::SpecConstant(CONSTANT_SOLVER, kind.ik.solver), gpu::SpecConstant(CONSTANT_PADDED, padded)})
    info.constants.push_back(constant);
  // Without a polish every leg would be listed.
  if (kind.ik.polish == 0) return;
  addListed(kernels);
  // Where texel buffers are quicker loads are dear, and choosing is not.
  if (needs.context.texelLoads() && addRigBones(kind, info)) {
    addRigLegs(kind, info);
    info.constants.emplace_back(CONSTANT_RIG_CHOSEN, true);
  }
}

// With the solvers that are there to be compared, where the herd has one of them.
void specialiseIk(const StageNeeds& needs, StageKernels& kernels) {
  if (needs.kind.ik.solver != shared::SOLVER_FABRIK)
    kernels.first.code = {embedded::ik_compared_comp_texel(), embedded::ik_compared_comp_storage()};
  specialiseSolve(needs, kernels);
}
void specialiseSwingAndIk(const StageNeeds& needs, StageKernels& kernels) {
  if (needs.kind.ik.solver != shared::SOLVER_FABRIK)
    kernels.first.code = {embedded::swing_ik_compared_comp_texel(),
                          embedded::swing_ik_compared_comp_storage()};
  specialiseSolve(needs, kernels);
}

}  // namespace

Stage ikStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return withHurt(Stage{StageId::ik,
                        {embedded::ik_comp_texel(), embedded::ik_comp_storage()},
                        {{BINDING_PARAMETERS, uniform},
                         {BINDING_RIG, load4},
                         {BINDING_BODY, load4},
                         {BINDING_FOOT, load4},
                         {BINDING_CHAIN, load4},
                         {BINDING_CHAIN_OUT, store},
                         {BINDING_MISS_OUT, store},
                         {BINDING_TIP_OUT, store},
                         {BINDING_LIST, store},
                         {BINDING_COUNTERS, store}},
                        Stage::Over::legs,
                        specialiseIk,
                        COUNTER_IK_DISPATCH_X},
                  {embedded::ik_hurt_comp_texel(), embedded::ik_hurt_comp_storage()});
}

Stage swingAndIkStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return withReact(withHurt(Stage{{StageId::swing, StageId::ik},
                                  {embedded::swing_ik_comp_texel(), embedded::swing_ik_comp_storage()},
                                  {{BINDING_PARAMETERS, uniform},
                                   {BINDING_RIG, load4},
                                   {BINDING_BODY, load4},
                                   {BINDING_STEP, load4},
                                   {BINDING_ARC, load4},
                                   {BINDING_FOOT_OUT, store},
                                   {BINDING_CHAIN, load4},
                                   {BINDING_CHAIN_OUT, store},
                                   {BINDING_MISS_OUT, store},
                                   {BINDING_TIP_OUT, store},
                                   {BINDING_LIST, store},
                                   {BINDING_COUNTERS, store}},
                                  Stage::Over::legs,
                                  specialiseSwingAndIk,
                                  COUNTER_IK_DISPATCH_X},
                            {embedded::swing_ik_hurt_comp_texel(), embedded::swing_ik_hurt_comp_storage()}),
                   {embedded::swing_ik_react_comp_texel(), embedded::swing_ik_react_comp_storage()},
                   {{BINDING_HEIGHTS, heights}});
}

Stage plantedIkStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  return withHurt(Stage{StageId::ik,
                        {embedded::ik_planted_comp_texel(), embedded::ik_planted_comp_storage()},
                        {{BINDING_PARAMETERS, uniform},
                         {BINDING_RIG, load4},
                         {BINDING_BODY, load4},
                         {BINDING_FOOT, load4},
                         {BINDING_START, load4},
                         {BINDING_CHAIN_OUT, store},
                         {BINDING_TIP_OUT, store},
                         {BINDING_FIX_OUT, store},
                         {BINDING_LIST, store},
                         {BINDING_COUNTERS, store}},
                        Stage::Over::legs,
                        specialiseSolve,
                        COUNTER_IK_DISPATCH_X},
                  {embedded::ik_planted_hurt_comp_texel(), embedded::ik_planted_hurt_comp_storage()},
                  {{BINDING_CHAIN, load4}});
}

}  // namespace skitter::crowd

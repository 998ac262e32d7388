#include "crowd/stage.h"

#include <algorithm>
#include <utility>

#include "crowd/controller.h"
#include "crowd/controllers/controllers.h"
#include "crowd/herd.h"
#include "shared/bindings.h"
#include "shared/ik_batch.h"
#include "skitter/records.h"

namespace skitter::crowd {
namespace {

bool isAskedFor(StageId stage, const CrowdOptions& options, const StageForms& forms) {
  switch (stage) {
    case StageId::avoid:
      return forms.avoids;
    case StageId::adapt:
      return forms.adapts;
    case StageId::react:
      return forms.reacts;
    case StageId::wake:
      return options.sleep;
    case StageId::pose:
      return options.pose;
    case StageId::measure:
      return options.measure;
    case StageId::footfall:
      return options.footfalls > 0;
    default:
      return true;
  }
}

// Puts the stages that `fused` makes at once in its place, where they stand in a row and none is given
// another shader.
void fuse(const CrowdOptions& options, const Stage& fused, std::vector<Stage>& stages) {
  std::vector<StageSet> parts;
  for (const StageId part : allStages)
    if (fused.makes.has(part)) parts.push_back(part);
  const bool given = std::ranges::any_of(options.shaders, [&](const StageShader& shader) {
    return std::ranges::find(parts, shader.stage, &StageSet::name) != parts.end();
  });
  const auto row = std::ranges::search(stages, parts, {}, &Stage::makes);
  if (given || row.empty()) return;
  *row.begin() = fused;
  stages.erase(row.begin() + 1, row.end());
}

void takeHurtForm(Stage& stage, bool reacts) {
  stage.code = *stage.hurtCode;
  stage.bindings.push_back({shared::BINDING_HURT, gpu::BindingKind::load4});
  stage.bindings.insert(stage.bindings.end(), stage.hurtBindings.begin(), stage.hurtBindings.end());
  if (!reacts || !stage.reactCode) return;
  stage.code = *stage.reactCode;
  stage.bindings.push_back({shared::BINDING_REACTION, gpu::BindingKind::load4});
  stage.bindings.push_back({shared::BINDING_CARRIED, gpu::BindingKind::load4});
  stage.bindings.insert(stage.bindings.end(), stage.reactBindings.begin(), stage.reactBindings.end());
}

// Whose turn it is, is known before the first stage.
void takeLevelForms(bool reacts, std::vector<Stage>& stages) {
  for (Stage& stage : stages)
    if (stage.levelCode) {
      stage.code = *stage.levelCode;
      stage.over = stage.over == Stage::Over::everyLeg ? Stage::Over::legs : Stage::Over::agents;
    }
  stages.insert(stages.begin(), reacts ? reactLevelWakeStage() : levelWakeStage());
}

void addParameters(const shared::Parameters& parameters, gpu::KernelInfo& info) {
#define ADD_KNOWN(i, name) info.constants.emplace_back(shared::CONSTANT_PARAMETERS + (i), parameters.name);
  KNOWN_PARAMETERS(ADD_KNOWN)
#undef ADD_KNOWN
}

}  // namespace

bool keepsFeet(const CrowdOptions& options) {
  return options.feet || options.measure || options.footfalls > 0;
}

std::vector<Stage> stagesOf(Controller controller, const CrowdOptions& options, const StageForms& forms) {
  const ControllerStages& of = controllerStages(controller);
  std::vector<Stage> stages = of.all(options);
  std::erase_if(stages, [&](const Stage& stage) {
    return std::ranges::any_of(
        allStages, [&](StageId id) { return stage.makes.has(id) && !isAskedFor(id, options, forms); });
  });
  const auto isOf = [](StageId id) { return [id](const Stage& stage) { return stage.makes == id; }; };
  if (options.levels) std::erase_if(stages, isOf(StageId::wake));
  const bool navigatesAlone = forms.findsWays || forms.forages || forms.reserves;
  if (options.fuse && of.fused != nullptr)
    for (const Stage& fused : of.fused())
      if (!navigatesAlone || !fused.makes.has(StageId::navigate)) fuse(options, fused, stages);
  if (forms.findsWays) std::ranges::replace_if(stages, isOf(StageId::navigate), wayNavigateStage());
  if (forms.forages) std::ranges::replace_if(stages, isOf(StageId::navigate), forageNavigateStage());
  if (forms.amongWalls) std::ranges::replace_if(stages, isOf(StageId::avoid), wallAvoidStage());
  if (forms.avoids) std::ranges::replace_if(stages, isOf(StageId::foothold), amongFootholdStage());
  if (options.levels) takeLevelForms(forms.reacts, stages);
  for (Stage& stage : stages)
    if (forms.hurts && stage.hurtCode) takeHurtForm(stage, forms.reacts);
  for (Stage& stage : stages)
    if (stage.isOfTheAwake()) stage.bindings.push_back({shared::BINDING_AWAKE, gpu::BindingKind::load4});
  return stages;
}

Stage withHurt(Stage stage, const gpu::ShaderCode& code, std::vector<gpu::BindingDecl> more) {
  stage.hurtCode = code;
  stage.hurtBindings = std::move(more);
  return stage;
}

Stage withReact(Stage stage, const gpu::ShaderCode& code, std::vector<gpu::BindingDecl> more) {
  stage.reactCode = code;
  stage.reactBindings = std::move(more);
  return stage;
}

void addListed(StageKernels& kernels) {
  kernels.listed = kernels.first;
  kernels.first.constants.emplace_back(shared::CONSTANT_PASS, shared::PASS_QUICK);
  kernels.listed->constants.emplace_back(shared::CONSTANT_PASS, shared::PASS_LISTED);
}

void addRigLegs(const Kind& kind, gpu::KernelInfo& info) {
  constexpr int aLeg = 4 * shared::RIG_LEG_STRIDE;
  const auto stride = 4 * static_cast<size_t>(shared::rigStride(kind.bones));
  for (int leg = 0; leg < kind.legs; ++leg)
    for (int i = 0; i < aLeg; ++i)
      info.constants.emplace_back(
          shared::CONSTANT_RIG_LEGS + leg * aLeg + i,
          kind.rigRecords[static_cast<size_t>(leg) * stride + static_cast<size_t>(i)]);
}

StageKernels kernelsOf(const Stage& stage, const StageNeeds& needs) {
  using namespace shared;
  const Kind& kind = needs.kind;
  StageKernels kernels{{stage.makes.name(), stage.code, stage.bindings, sizeof(TickConstants)}};
  kernels.first.constants = {{CONSTANT_LEGS, kind.legs},
                             {CONSTANT_BONES, kind.bones},
                             {CONSTANT_GROUPS, kind.groups},
                             {CONSTANT_HERD_STEPS, kind.herdSteps}};
  addParameters(kind.parameters, kernels.first);
  const ControllerStages& of = controllerStages(kind.controller);
  if (kind.rests(needs.options))
    kernels.first.constants.emplace_back(
        CONSTANT_SLEEP, traitsOf(kind.controller).breathes ? SLEEP_BREATHED_OUT : SLEEP_STILL);
  if (kind.reserves) kernels.first.constants.emplace_back(CONSTANT_RESERVE, true);
  // Others read no list, and go by the crowd's ticks.
  if (needs.options.levels && (stage.isOfTheAwake() || stage.over == Stage::Over::listed))
    kernels.first.constants.emplace_back(CONSTANT_LEVELS, true);
  if (kind.avoids) kernels.first.constants.emplace_back(CONSTANT_AVOIDS, true);
  if (of.specialise != nullptr) of.specialise(kind, kernels.first);
  if (stage.specialise != nullptr) stage.specialise(needs, kernels);
  for (const StageShader& given : needs.options.shaders) {
    if (given.stage != kernels.first.name) continue;
    const gpu::ShaderCode code{given.texel, given.storage};
    kernels.first.code = code;
    if (kernels.listed) kernels.listed->code = code;
    if (kernels.afterEdit) kernels.afterEdit->code = code;
  }
  return kernels;
}

void makeKernels(const StageNeeds& needs, ReadyStage& stage) {
  const StageKernels kernels = kernelsOf(stage, needs);
  stage.first = gpu::Kernel(needs.context, kernels.first);
  if (kernels.listed) stage.listed = gpu::Kernel(needs.context, *kernels.listed);
  if (kernels.afterEdit) stage.afterEdit = gpu::Kernel(needs.context, *kernels.afterEdit);
}

}  // namespace skitter::crowd

#include "crowd/stage.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string_view>

#include "crowd/herd.h"
#include "crowd/tuning.h"
#include "shared/bindings.h"
#include "shared/ik_batch.h"
#include "skitter/error.h"

namespace skitter::crowd {
namespace {

std::vector<Stage> everyStageOf(Controller controller) {
  switch (controller) {
    case Controller::clip:
      return {navigateStage(),  wakeStage(),     blindBodyStage(), clipStage(),
              clipSwingStage(), clipPoseStage(), measureStage(),   footfallStage()};
    case Controller::planted:
      return {navigateStage(),  wakeStage(),        blindBodyStage(), clipStage(),    plantedSwingStage(),
              plantedIkStage(), plantedPoseStage(), measureStage(),   footfallStage()};
    case Controller::pose:
      return {navigateStage(),     wakeStage(), blindBodyStage(), keyPoseGaitStage(),
              keyPoseSwingStage(), poseStage(), measureStage(),   footfallStage()};
    case Controller::loop:
      return {navigateStage(), wakeStage(), blindBodyStage(), loopGaitStage(), loopSwingStage(),
              ikStage(),       poseStage(), measureStage(),   footfallStage()};
    case Controller::adaptive:
      break;
  }
  return {navigateStage(), wakeStage(), bodyStage(), gaitStage(),    footholdStage(),
          swingStage(),    ikStage(),   poseStage(), measureStage(), footfallStage()};
}

// Puts the stages that `fused` makes at once in its place, where they stand in a row and none is given
// another shader.
void fuse(const CrowdOptions& options, const Stage& fused, std::vector<Stage>& stages) {
  const auto isPart = [&](const Stage& stage) { return makes(fused.name, stage.name); };
  const bool given =
      std::any_of(options.shaders.begin(), options.shaders.end(), [&](const StageShader& shader) {
        return shader.stage != fused.name && makes(fused.name, shader.stage);
      });
  const auto first = std::find_if(stages.begin(), stages.end(), isPart);
  const auto last = std::find_if_not(first, stages.end(), isPart);
  const auto parts = 1 + std::count(fused.name, fused.name + std::strlen(fused.name), '+');
  if (given || last - first != parts) return;
  *first = fused;
  stages.erase(first + 1, last);
}

}  // namespace

Controller controllerNamed(const std::string& name) {
  if (name == "adaptive") return Controller::adaptive;
  if (name == "loop") return Controller::loop;
  if (name == "clip") return Controller::clip;
  if (name == "planted") return Controller::planted;
  if (name == "pose") return Controller::pose;
  throw inputError("controller '" + name + "' is unknown; there are: adaptive, loop, clip, planted, pose");
}

const std::vector<const char*>& frame() {
  static const std::vector<const char*> names = {"navigate",  "wake",     "body", "navigate+body+gait",
                                                 "body+gait", "clip",     "gait", "foothold",
                                                 "swing",     "swing+ik", "ik",   "pose",
                                                 "measure",   "footfall"};
  return names;
}

std::vector<Stage> stagesOf(Controller controller, const CrowdOptions& options) {
  std::vector<Stage> stages = everyStageOf(controller);
  std::erase_if(stages, [&](const Stage& stage) {
    const std::string_view name = stage.name;
    if (name == "wake") return !options.sleep;
    if (name == "pose") return !options.pose;
    if (name == "measure") return !options.measure;
    if (name == "footfall") return options.footfalls == 0;
    // Of a clip as it is, feet are looked at by measure alone.
    if (name == "swing" && controller == Controller::clip) return !keepsFeet(options);
    return false;
  });
  if (options.fuse && controller == Controller::adaptive)
    for (const Stage& fused : {navigateBodyAndGaitStage(), bodyAndGaitStage(), swingAndIkStage()})
      fuse(options, fused, stages);
  for (Stage& stage : stages)
    if (isOfTheAwake(stage)) stage.bindings.push_back({shared::BINDING_AWAKE, gpu::BindingKind::load4});
  return stages;
}

bool makes(std::string_view stage, std::string_view part) {
  for (size_t plus; (plus = stage.find('+')) != stage.npos; stage.remove_prefix(plus + 1))
    if (stage.substr(0, plus) == part) return true;
  return stage == part;
}

bool keepsFeet(const CrowdOptions& options) {
  return options.feet || options.measure || options.footfalls > 0;
}

bool isOfTheAwake(const Stage& stage) {
  return stage.over == Stage::Over::agents || stage.over == Stage::Over::legs ||
         stage.over == Stage::Over::joints;
}

bool hasFootRecords(const Herd& herd, const CrowdOptions& options) {
  return keepsFeet(options) || std::none_of(herd.stages.begin(), herd.stages.end(), [](const Stage& stage) {
           return makes(stage.name, "swing") && makes(stage.name, "ik");
         });
}

namespace {

void addRigLegs(const Herd& herd, gpu::KernelInfo& info) {
  constexpr int aLeg = 4 * shared::RIG_LEG_STRIDE;
  const auto stride = 4 * static_cast<size_t>(shared::rigStride(herd.bones));
  for (int leg = 0; leg < herd.legs; ++leg)
    for (int i = 0; i < aLeg; ++i)
      info.constants.emplace_back(
          shared::CONSTANT_RIG_LEGS + leg * aLeg + i,
          herd.rigRecords[static_cast<size_t>(leg) * stride + static_cast<size_t>(i)]);
}

void addParameters(const shared::Parameters& parameters, gpu::KernelInfo& info) {
#define ADD_KNOWN(i, name) info.constants.emplace_back(shared::CONSTANT_PARAMETERS + (i), parameters.name);
  KNOWN_PARAMETERS(ADD_KNOWN)
#undef ADD_KNOWN
}

// Where the rig has fewer legs than there are constants of, its own follow each other again: equal ones need
// not be chosen from.
bool addRigBones(const Herd& herd, gpu::KernelInfo& info) {
  using namespace shared;
  if (herd.legs > CHOSEN_LEGS || herd.bones > CHOSEN_BONES) return false;
  for (int bone = 0; bone < herd.bones; ++bone)
    for (int i = 0; i < 4; ++i)
      for (int leg = 0; leg < CHOSEN_LEGS; ++leg) {
        const int at =
            4 * ((leg % herd.legs) * rigStride(herd.bones) + RIG_LEG_STRIDE + RIG_BONE_STRIDE * bone + 7) + i;
        info.constants.emplace_back(CONSTANT_RIG_BONES + (4 * bone + i) * CHOSEN_LEGS + leg,
                                    herd.rigRecords[static_cast<size_t>(at)]);
      }
  return true;
}

}  // namespace

StageKernels kernelsOf(const gpu::Context& context, const Stage& stage, const CrowdOptions& options,
                       const Herd& herd) {
  using namespace shared;
  gpu::KernelInfo info{stage.name, stage.code, stage.bindings, sizeof(TickConstants)};
  const bool isIk = makes(stage.name, "ik");
  const bool isGait = herd.controller == Controller::adaptive && makes(stage.name, "gait");
  if (isIk && herd.ik.solver != SOLVER_FABRIK) info.code = comparedIkCode(makes(stage.name, "swing"));
  for (const StageShader& other : options.shaders)
    if (other.stage == stage.name) info.code = {other.texel, other.storage};
  info.constants = {{CONSTANT_LEGS, herd.legs}, {CONSTANT_BONES, herd.bones}, {CONSTANT_GROUPS, herd.groups}};
  addParameters(herd.parameters, info);
  if (isIk || (herd.controller == Controller::pose && makes(stage.name, "swing")))
    info.constants.emplace_back(CONSTANT_FEET, keepsFeet(options));
  if (options.sleep) {
    const bool breathes = herd.controller == Controller::adaptive;
    info.constants.emplace_back(CONSTANT_SLEEP, breathes ? SLEEP_BREATHED_OUT : SLEEP_STILL);
  }
  if (playsClips(herd.controller)) {
    info.constants.emplace_back(CONSTANT_CLIPS, herd.clips.clips);
    info.constants.emplace_back(CONSTANT_JOINTS, herd.clips.joints);
    info.constants.emplace_back(CONSTANT_SEARCH_STEPS,
                                static_cast<int>(std::bit_width(static_cast<uint32_t>(herd.clips.frames))));
  }
  if (isIk) {
    info.constants.emplace_back(CONSTANT_APPROACH_ITERATIONS, herd.ik.approach);
    info.constants.emplace_back(CONSTANT_POLISH_ITERATIONS, herd.ik.polish);
    info.constants.emplace_back(CONSTANT_SOLVER, herd.ik.solver);
    const bool padded = std::any_of(herd.rig.legs.begin(), herd.rig.legs.end(), [&](const Leg& leg) {
      return static_cast<int>(leg.bones.size()) < herd.bones;
    });
    info.constants.emplace_back(CONSTANT_PADDED, padded);
  }
  if (makes(stage.name, "body") || isGait) addRigLegs(herd, info);
  if (isGait) info.constants.emplace_back(CONSTANT_REACH, herd.reachTriggered ? 1 : 0);

  StageKernels kernels{info, {}, {}};
  // Without a polish ik would list every leg.
  if (stage.rest >= 0 && !(isIk && herd.ik.polish == 0)) {
    kernels.first.constants.emplace_back(CONSTANT_PASS, PASS_QUICK);
    // Where texel buffers are quicker loads are dear, and choosing is not.
    if (isIk && context.texelLoads() && addRigBones(herd, kernels.first)) {
      addRigLegs(herd, kernels.first);
      kernels.first.constants.emplace_back(CONSTANT_RIG_CHOSEN, true);
    }
    kernels.rest = info;
    kernels.rest->constants.emplace_back(CONSTANT_PASS, PASS_LISTED);
  }
  if (isGait) {
    kernels.watching = info;
    kernels.watching->constants.emplace_back(CONSTANT_WATCH, 1);
  }
  return kernels;
}

void makeKernels(const gpu::Context& context, const CrowdOptions& options, Herd& herd) {
  for (const Stage& stage : herd.stages) {
    const StageKernels kernels = kernelsOf(context, stage, options, herd);
    herd.kernels.emplace_back(context, kernels.first);
    gpu::Kernel& rest = herd.restKernels.emplace_back();
    if (kernels.rest) rest = gpu::Kernel(context, *kernels.rest);
    if (kernels.watching) herd.watchingGait = gpu::Kernel(context, *kernels.watching);
  }
}

}  // namespace skitter::crowd

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "crowd/controller.h"
#include "gpu/kernel.h"
#include "skitter/crowd.h"

namespace skitter::crowd {

// A stage of the frame: one compute shader, the records it binds, and what it runs over.
struct Stage {
  // agents, legs, joints (of the clips' palette): of those that are awake; listed: the legs that begin a
  // step, counted on the device; watched: agents whom measure looks at.
  enum class Over { everyone, everyLeg, blocks, agents, legs, joints, listed, watched };

  const char* name;
  gpu::ShaderCode code;
  std::vector<gpu::BindingDecl> bindings;
  Over over;
  // Where the counters have the indirect dispatch over what few agents or legs need and the first dispatch
  // leaves out; -1: it leaves out nothing.
  int rest = -1;
};

// Every stage's name in the order in which they are recorded; a controller has those that it needs.
const std::vector<const char*>& frame();
// A controller's stages, in that order, less those that make what nobody asked for.
std::vector<Stage> stagesOf(Controller controller, const CrowdOptions& options);

// Whether a stage of that name is the other, or makes several at once, as "body+gait" does, the other among
// them.
bool makes(std::string_view stage, std::string_view part);

// Whether somebody looks at feet: ik, or what takes its place, writes tips, and what makes swing and ik at
// once feet.
bool keepsFeet(const CrowdOptions& options);

// Whether it passes over those who sleep.
bool isOfTheAwake(const Stage& stage);

struct Herd;

// Whether feet go from one stage to another through records, or somebody looks at them.
bool hasFootRecords(const Herd& herd, const CrowdOptions& options);

// A stage's shader, specialised by the herd's legs, bones and groups: for its first dispatch, for what that
// leaves out (Stage::rest) and, of gait, for the ticks after an edit of the heights.
struct StageKernels {
  gpu::KernelInfo first;
  std::optional<gpu::KernelInfo> rest, watching;
};
StageKernels kernelsOf(const gpu::Context& context, const Stage& stage, const CrowdOptions& options,
                       const Herd& herd);
// The pipelines of all stages of the controller.
void makeKernels(const gpu::Context& context, const CrowdOptions& options, Herd& herd);

// Each in a file of its own name.
Stage navigateStage();
Stage wakeStage();
Stage bodyStage();
Stage blindBodyStage();
Stage clipStage();
Stage gaitStage();
Stage bodyAndGaitStage();
Stage navigateBodyAndGaitStage();
Stage loopGaitStage();
Stage keyPoseGaitStage();
Stage footholdStage();
Stage swingStage();
Stage loopSwingStage();
Stage clipSwingStage();
Stage plantedSwingStage();
Stage keyPoseSwingStage();
Stage ikStage();
Stage swingAndIkStage();
Stage plantedIkStage();
// Of ik, or of swing and ik, with the solvers that are there to be compared.
gpu::ShaderCode comparedIkCode(bool withSwing);
Stage poseStage();
Stage clipPoseStage();
Stage plantedPoseStage();
Stage measureStage();
Stage footfallStage();

}  // namespace skitter::crowd

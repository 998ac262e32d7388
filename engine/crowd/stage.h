#pragma once

#include <optional>
#include <vector>

#include "crowd/stage_id.h"
#include "gpu/kernel.h"
#include "skitter/crowd.h"

namespace skitter::crowd {

struct Kind;

// A stage's shader, specialised: for its first dispatch, for what that leaves out (Stage::listedArguments),
// and for the ticks after an edit of the heights.
struct StageKernels {
  gpu::KernelInfo first;
  std::optional<gpu::KernelInfo> listed = {}, afterEdit = {};
};
// What it is specialised by.
struct StageNeeds {
  const gpu::Context& context;
  const CrowdOptions& options;
  const Kind& kind;
};

// One compute shader: the stages that it makes, the records that it binds, and what it runs over.
struct Stage {
  // lookers: those who look around in the tick, where a herd avoids; agents, legs, joints (of the clips'
  // palette): of those that are awake, or whose turn it is; listed: the legs that begin a step, counted on
  // the device; watched: agents whom measure looks at.
  enum class Over { everyone, everyLeg, blocks, lookers, agents, legs, joints, listed, watched };

  StageSet makes;
  gpu::ShaderCode code;
  std::vector<gpu::BindingDecl> bindings;
  Over over;
  // Adds what this shader alone is specialised by, and says which kernels it has beside the first.
  void (*specialise)(const StageNeeds& needs, StageKernels& kernels) = nullptr;
  // Where the counters have the indirect dispatch over what few agents or legs need and the first dispatch
  // leaves out; -1: it leaves out nothing.
  int listedArguments = -1;
  // In the crowd's grid, whose constants it has.
  bool seesCrowd = false;
  // In herds that can be hurt: its form, and what that binds beside BINDING_HURT.
  std::optional<gpu::ShaderCode> hurtCode = {};
  std::vector<gpu::BindingDecl> hurtBindings = {};
  // In herds with reactions, which can be hurt, too: a form in place of that, and what it binds beside that
  // one, BINDING_REACTION and BINDING_CARRIED.
  std::optional<gpu::ShaderCode> reactCode = {};
  std::vector<gpu::BindingDecl> reactBindings = {};
  // Where there are levels of rate: its form over those whose turn it is, in place of one over everyone.
  std::optional<gpu::ShaderCode> levelCode = {};

  // Whether it passes over those who sleep.
  bool isOfTheAwake() const { return over == Over::agents || over == Over::legs || over == Over::joints; }
};

// A stage of a kind, with its pipelines.
struct ReadyStage : Stage {
  gpu::Kernel first = {}, listed = {}, afterEdit = {};
};

// Whether somebody looks at feet: ik, or what takes its place, writes tips, and what makes swing and ik at
// once feet.
bool keepsFeet(const CrowdOptions& options);

// What a herd is, where its stages have forms for it.
struct StageForms {
  bool avoids = false;      // keeps clear of others
  bool findsWays = false;   // goes by fields
  bool forages = false;     // goes by trails
  bool amongWalls = false;  // avoids, and there are obstacles
  bool hurts = false;       // can be hurt
  bool reacts = false;      // has reactions, and can be hurt
  bool adapts = false;      // tries gaits when it is hurt
  bool reserves = false;    // places may be empty
};
// A controller's stages, in order, less those that make what nobody asked for.
std::vector<Stage> stagesOf(Controller controller, const CrowdOptions& options, const StageForms& forms = {});
StageKernels kernelsOf(const Stage& stage, const StageNeeds& needs);
// Makes the pipelines, for the kind's rig, controller and tuning.
void makeKernels(const StageNeeds& needs, ReadyStage& stage);

// For what stages have in common.
//
// The stage, with its form for herds that can be hurt.
Stage withHurt(Stage stage, const gpu::ShaderCode& code, std::vector<gpu::BindingDecl> more = {});
// The stage, which has a form for herds that can be hurt, with one for herds with reactions.
Stage withReact(Stage stage, const gpu::ShaderCode& code, std::vector<gpu::BindingDecl> more = {});
// A second kernel, for what the first dispatch lists and leaves out.
void addListed(StageKernels& kernels);
// The numbers with which the rig's records of legs begin.
void addRigLegs(const Kind& kind, gpu::KernelInfo& info);

// navigateStage() and so on, each in the file of its name in stages/.
#define SKITTER_STAGE(name) Stage name##Stage();
SKITTER_STAGES(SKITTER_STAGE)
#undef SKITTER_STAGE
// Forms for single controllers, and fused stages, in the file of their last stage.
Stage wayNavigateStage();
Stage forageNavigateStage();
Stage wallAvoidStage();
Stage amongFootholdStage();
Stage blindBodyStage();
Stage bodyAndGaitStage();
Stage navigateBodyAndGaitStage();
Stage levelWakeStage();
Stage reactLevelWakeStage();
Stage loopGaitStage();
Stage keyPoseGaitStage();
Stage loopSwingStage();
Stage clipSwingStage();
Stage plantedSwingStage();
Stage keyPoseSwingStage();
Stage swingAndIkStage();
Stage plantedIkStage();
Stage clipPoseStage();
Stage plantedPoseStage();

}  // namespace skitter::crowd

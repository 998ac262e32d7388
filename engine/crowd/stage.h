#pragma once

#include <vector>

#include "gpu/kernel.h"
#include "skitter/crowd.h"

namespace skitter::crowd {

// A stage of the frame: one compute shader, the records it binds, and what it runs over.
struct Stage {
  enum class Over { agents, legs, listed };  // listed: the legs that begin a step, counted on the device

  const char* name;
  gpu::ShaderCode code;
  std::vector<gpu::BindingDecl> bindings;
  Over over;
};

// The frame: every stage in the order in which it is recorded.
const std::vector<Stage>& stages();

struct Herd;
// A pipeline a stage, specialised by the herd's legs, bones and groups.
void makeKernels(const gpu::Context& context, const CrowdOptions& options, Herd& herd);

// Each in a file of its own name.
Stage navigateStage();
Stage bodyStage();
Stage gaitStage();
Stage footholdStage();
Stage swingStage();
Stage ikStage();
// Of the ik stage with the solvers that are there to be compared.
gpu::ShaderCode comparedIkCode();
Stage poseStage();
Stage measureStage();

}  // namespace skitter::crowd

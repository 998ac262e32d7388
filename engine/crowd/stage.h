#pragma once

#include <vector>

#include "gpu/kernel.h"

namespace skitter::crowd {

// A stage of the frame: one compute shader, the records it binds, and what it runs over.
struct Stage {
  enum class Over { agents, legs, listed };  // listed: the legs that begin a step, counted on the device

  const char* name;
  gpu::ShaderCode code;
  std::vector<gpu::BindingDecl> bindings;
  Over over;
};

// Each in a file of its own name, in the frame's order.
Stage navigateStage();
Stage bodyStage();
Stage gaitStage();
Stage footholdStage();
Stage swingStage();
Stage ikStage();
Stage poseStage();
Stage measureStage();

}  // namespace skitter::crowd

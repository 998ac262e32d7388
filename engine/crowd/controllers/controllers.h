#pragma once

#include <string>
#include <vector>

#include "crowd/controller.h"
#include "crowd/herd.h"
#include "crowd/stage.h"
#include "skitter/scene.h"

namespace skitter::crowd {

struct ControllerStages {
  // In order; those that make what nobody asked for are left out by others.
  std::vector<Stage> (*all)(const CrowdOptions& options);
  // Each makes some of them at once, and is quicker; none: nullptr, as with what follows.
  std::vector<Stage> (*fused)() = nullptr;
  // Adds what the shaders of all its stages are specialised by.
  void (*specialise)(const Kind& kind, gpu::KernelInfo& info) = nullptr;
  // Loads what the controller needs for a kind that has its rig; `loaded` is the rig at size 1. Refuses what
  // cannot be by Error(input).
  void (*prepare)(const gpu::Context& context, const skitter::Herd& from, const Rig& loaded,
                  Kind& kind) = nullptr;
  // Refuses ticks of that length by Error(input).
  void (*checkTick)(const Kind& kind, float dt) = nullptr;
};

const ControllerStages& controllerStages(Controller controller);

// adaptiveController and so on, each in the file of its name.
#define SKITTER_CONTROLLER(name) extern const ControllerStages name##Controller;
SKITTER_CONTROLLERS(SKITTER_CONTROLLER)
#undef SKITTER_CONTROLLER

// What those that need clips have in common.
ClipSet clipSetOf(const skitter::Herd& from, const Rig& loaded, float size);
std::vector<std::string> clipNames(const skitter::Herd& from);
gpu::Buffer constantBuffer(const gpu::Context& context, const std::vector<float>& records, const char* name);
// And those that play them.
void loadClips(const gpu::Context& context, const skitter::Herd& from, const Rig& loaded, Kind& kind);
void addClips(const Kind& kind, gpu::KernelInfo& info);

}  // namespace skitter::crowd

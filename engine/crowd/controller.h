#pragma once

#include "skitter/controller.h"

// What sets the controllers apart, as plain data; their stages are in crowd/controllers.
namespace skitter::crowd {

// Every controller, in any order. One that is forgotten here does not compile (controllers.cpp).
#define SKITTER_CONTROLLERS(CONTROLLER) \
  CONTROLLER(adaptive) CONTROLLER(loop) CONTROLLER(clip) CONTROLLER(planted) CONTROLLER(keyPoses)

struct ControllerTraits {
  bool playsClips = false;   // in every tick
  bool needsClips = false;   // played, or sampled for key poses
  bool aimsSteps = false;    // feet go by steps that foothold aims
  bool tellsMisses = false;  // ik tells which planted feet miss their targets
  bool keepsLimits = false;  // legs are solved within the rig's limits; clips know none
  bool canBeHurt = false;    // its stages have forms for legs that do not carry (Stage::hurt)
  bool breathes = false;     // a body at rest does, and sleeps once it has breathed out
};
constexpr ControllerTraits traitsOf(Controller controller) {
  switch (controller) {
    case Controller::adaptive:
      return {
          .aimsSteps = true, .tellsMisses = true, .keepsLimits = true, .canBeHurt = true, .breathes = true};
    case Controller::loop:
      return {.tellsMisses = true, .keepsLimits = true, .canBeHurt = true};
    case Controller::clip:
      return {.playsClips = true, .needsClips = true};
    case Controller::planted:
      return {.playsClips = true, .needsClips = true, .canBeHurt = true};
    case Controller::keyPoses:
      return {.needsClips = true};
  }
  return {};
}

}  // namespace skitter::crowd

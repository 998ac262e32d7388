#pragma once

#include "skitter/enum_names.h"

namespace skitter {

// How the legs of a herd move (docs/scene.md).
enum class Controller {
  adaptive,         // steps to footholds that are chosen on the ground
  loop,             // each foot runs on a fixed loop
  clip,             // plays animations
  planted,          // plays animations, and puts their feet on the ground
  keyPoses,         // joins a few key poses of an animation
  pose = keyPoses,  // its earlier name
};
inline constexpr std::array allControllers = {Controller::adaptive, Controller::loop, Controller::clip,
                                              Controller::planted, Controller::keyPoses};
constexpr const char* nameOf(Controller controller) {
  constexpr std::array names = {"adaptive", "loop", "clip", "planted", "key-poses"};
  static_assert(names.size() == allControllers.size());
  return names[static_cast<size_t>(controller)];
}
constexpr bool isEarlierName(Controller controller, std::string_view name) {
  return controller == Controller::keyPoses && name == "pose";
}
constexpr std::optional<Controller> controllerNamed(std::string_view name) {
  return enumNamed(allControllers, name);
}

// When the legs of an adaptive herd step.
enum class Stepping {
  gait,   // in a rhythm
  reach,  // each by itself, when its foot gets out of reach
};
inline constexpr std::array allSteppings = {Stepping::gait, Stepping::reach};
constexpr const char* nameOf(Stepping stepping) { return stepping == Stepping::gait ? "gait" : "reach"; }
constexpr std::optional<Stepping> steppingNamed(std::string_view name) {
  return enumNamed(allSteppings, name);
}

}  // namespace skitter

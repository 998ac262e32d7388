#pragma once

#include <array>
#include <optional>
#include <span>

#include "skitter/controller.h"

namespace skitter::app {

// What keys do in a window.
enum class Action {
  none,  // of the mouse
  forward,
  back,
  left,
  right,
  up,
  down,
  hurry,
  followNext,
  sceneCamera,
  pause,
  step,
  faster,
  slower,
  restart,
  adaptive,
  loop,
  clip,
  planted,
  keyPoses,
  chains,
  footholds,
  splines,
  support,
  help,
  figures,
  screenshot,
  close,
};

// A row of the help and of docs/viewer.md.
struct KeyRow {
  const char* group;
  const char* name;
  const char* text;
  Action action = Action::none;
  int key = 0;        // GLFW's
  bool held = false;  // acts for as long as it is held
};
std::span<const KeyRow> keyRows();

// The action of a GLFW key. Keys that act while they are held have none.
std::optional<Action> actionOf(int key);
// The controller that an action chooses.
std::optional<Controller> controllerOf(Action action);

}  // namespace skitter::app

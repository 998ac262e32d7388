#include "app/viewer/keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

namespace skitter::app {
namespace {

constexpr KeyRow keyTable[] = {
    {"Camera", "Left drag", "turn about the middle, or about the agent that is followed"},
    {"Camera", "Right drag", "move sideways"},
    {"Camera", "Wheel", "come closer, go further away"},
    {"Camera", "W", "fly forward", Action::forward, GLFW_KEY_W, true},
    {"Camera", "S", "fly back", Action::back, GLFW_KEY_S, true},
    {"Camera", "A", "fly left", Action::left, GLFW_KEY_A, true},
    {"Camera", "D", "fly right", Action::right, GLFW_KEY_D, true},
    {"Camera", "E", "fly up", Action::up, GLFW_KEY_E, true},
    {"Camera", "Q", "fly down", Action::down, GLFW_KEY_Q, true},
    {"Camera", "Shift", "with these: four times as fast", Action::hurry, GLFW_KEY_LEFT_SHIFT, true},
    {"Camera", "C", "the scene's camera again", Action::sceneCamera, GLFW_KEY_C},
    {"Agent", "Click", "follow an agent; on empty ground: no longer"},
    {"Agent", "Tab", "follow the one in the middle, then the next; with Shift the one before",
     Action::followNext, GLFW_KEY_TAB},
    {"Agent", "F5", "its legs as chains, with the cones that limit their joints", Action::chains,
     GLFW_KEY_F5},
    {"Agent", "F6", "its footholds, and the ladder of candidates of each step", Action::footholds,
     GLFW_KEY_F6},
    {"Agent", "F7", "the splines of the feet in the air", Action::splines, GLFW_KEY_F7},
    {"Agent", "F8", "its support polygon and centre", Action::support, GLFW_KEY_F8},
    {"Time", "Space", "pause, go on", Action::pause, GLFW_KEY_SPACE},
    {"Time", "Right", "one tick, then pause", Action::step, GLFW_KEY_RIGHT},
    {"Time", "Up", "twice as fast, up to 16 times", Action::faster, GLFW_KEY_UP},
    {"Time", "Down", "half as fast, down to 1/16", Action::slower, GLFW_KEY_DOWN},
    {"Time", "R", "start again", Action::restart, GLFW_KEY_R},
    {"Controller", "1", "adaptive: footholds on the ground", Action::adaptive, GLFW_KEY_1},
    {"Controller", "2", "loop: feet on fixed loops", Action::loop, GLFW_KEY_2},
    {"Controller", "3", "clip: plays the model's animation", Action::clip, GLFW_KEY_3},
    {"Controller", "4", "planted: a clip with its feet on the ground", Action::planted, GLFW_KEY_4},
    {"Controller", "5", "key-poses: key poses and springs", Action::keyPoses, GLFW_KEY_5},
    {"Window", "F1", "this help; its rows can be clicked", Action::help, GLFW_KEY_F1},
    {"Window", "F2", "figures: agents, rates, time by stage", Action::figures, GLFW_KEY_F2},
    {"Window", "F12", "screenshot: skitter-0001.png and so on, where skitter was started", Action::screenshot,
     GLFW_KEY_F12},
    {"Window", "Esc", "close", Action::close, GLFW_KEY_ESCAPE},
};

}  // namespace

std::span<const KeyRow> keyRows() { return keyTable; }

std::optional<Action> actionOf(int key) {
  const auto row = std::find_if(std::begin(keyTable), std::end(keyTable),
                                [&](const KeyRow& r) { return r.key == key && !r.held; });
  if (row == std::end(keyTable) || row->action == Action::none) return std::nullopt;
  return row->action;
}

std::optional<Controller> controllerOf(Action action) {
  switch (action) {
    case Action::adaptive:
      return Controller::adaptive;
    case Action::loop:
      return Controller::loop;
    case Action::clip:
      return Controller::clip;
    case Action::planted:
      return Controller::planted;
    case Action::keyPoses:
      return Controller::keyPoses;
    default:
      return std::nullopt;
  }
}

}  // namespace skitter::app

#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "skitter/crowd.h"
#include "skitter/scene.h"

namespace skitter::experiments {

// A controller as the experiments show it, beside what the dissertation found of its like.
struct Subject {
  Controller controller;
  const char* title;
  int dissertationAgents;  // before performance problems were visible; 0: it had none such
  const char* colour;
};
inline constexpr std::array subjects = {
    Subject{Controller::clip, "clip (pre-animated)", 20, "#0072b2"},
    Subject{Controller::planted, "planted (clip, feet put down by IK)", 0, "#c98a00"},
    Subject{Controller::keyPoses, "key-poses (a few key poses, springs)", 0, "#cc79a7"},
    Subject{Controller::loop, "loop (procedural, fixed foot loops)", 9, "#009e73"},
    Subject{Controller::adaptive, "adaptive (procedural, footholds on terrain)", 4, "#d55e00"},
};
static_assert(subjects.size() == allControllers.size());

// Built-in spiders in lanes across the ground, at a speed in metres a second.
Scene crossing(Controller controller, uint32_t agents, double speed, uint64_t seed);

// What an agent does, in world metres.
struct LegState {
  glm::dvec3 foot{0};
  bool stance = false;
};
struct AgentState {
  glm::dvec3 position{0};
  glm::dvec2 heading{0, 1};  // x, z
  std::vector<LegState> legs;
};
std::vector<AgentState> agentsOf(const HerdState& state, const Rig& rig);

// Metres between the ground below a rig's feet at home, about a body that stands there, and the plane that
// fits it best: root of the mean square.
double roughnessAt(const Heightfield& ground, const Rig& rig, const glm::dvec3& position,
                   const glm::dvec2& heading);

}  // namespace skitter::experiments

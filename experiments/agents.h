#pragma once

#include <array>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "skitter/crowd.h"
#include "skitter/scene.h"

namespace skitter::experiments {

// A controller as the experiments name it, beside what the dissertation found of its like.
struct Controller {
  const char* name;
  const char* title;
  int dissertationAgents;  // before performance problems were visible; 0: it had none such
  const char* colour;
};
inline constexpr std::array<Controller, 5> allControllers = {{
    {"clip", "clip (pre-animated)", 20, "#0072b2"},
    {"planted", "planted (clip, feet put down by IK)", 0, "#c98a00"},
    {"pose", "pose (a few key poses, springs)", 0, "#cc79a7"},
    {"loop", "loop (procedural, fixed foot loops)", 9, "#009e73"},
    {"adaptive", "adaptive (procedural, footholds on terrain)", 4, "#d55e00"},
}};

// Built-in spiders in lanes across the ground, at a speed in metres a second.
Scene crossing(const std::string& controller, uint32_t agents, double speed, uint64_t seed);

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

#include "experiments/agents.h"

#include <cmath>

#include "skitter/records.h"

namespace skitter::experiments {

Scene crossing(Controller controller, uint32_t agents, double speed, uint64_t seed) {
  Scene scene = builtinScene();
  scene.seed = seed;
  Herd herd;
  herd.controller = controller;
  herd.agents = agents;
  herd.goal.speed = static_cast<float>(speed);
  scene.herds = {herd};
  return scene;
}

std::vector<AgentState> agentsOf(const HerdState& state, const Rig& rig) {
  using namespace shared;
  const auto legs = static_cast<size_t>(rig.legCount());
  std::vector<AgentState> agents(state.agents);
  for (size_t a = 0; a < agents.size(); ++a) {
    AgentState& agent = agents[a];
    const float* body = state.body.data() + 4 * a * BODY_STRIDE;
    agent.position = {double{tileX(body[3])} * TILE_SIZE + body[0], body[1],
                      double{tileZ(body[3])} * TILE_SIZE + body[2]};
    agent.heading = {body[4], body[5]};
    for (size_t leg = a * legs; leg < (a + 1) * legs; ++leg) {
      const float* at = state.tip.data() + 4 * leg * TIP_STRIDE;
      agent.legs.push_back(
          {agent.position + glm::dvec3(at[0], at[1], at[2]), state.foot[4 * leg * FOOT_STRIDE + 3] >= 1});
    }
  }
  return agents;
}

double roughnessAt(const Heightfield& ground, const Rig& rig, const glm::dvec3& position,
                   const glm::dvec2& heading) {
  std::vector<glm::dvec3> feet;
  glm::dvec3 mean(0);
  for (const Leg& leg : rig.legs) {
    const double x = position.x + heading.y * leg.home.x + heading.x * leg.home.z;
    const double z = position.z - heading.x * leg.home.x + heading.y * leg.home.z;
    feet.emplace_back(x, ground.at(static_cast<float>(x), static_cast<float>(z)), z);
    mean += feet.back() / static_cast<double>(rig.legs.size());
  }
  double xx = 0, xz = 0, zz = 0, xy = 0, zy = 0;
  for (const glm::dvec3& foot : feet) {
    const glm::dvec3 d = foot - mean;
    xx += d.x * d.x, xz += d.x * d.z, zz += d.z * d.z, xy += d.x * d.y, zy += d.z * d.y;
  }
  const double determinant = xx * zz - xz * xz;
  const double b = determinant > 0 ? (xy * zz - zy * xz) / determinant : 0;
  const double c = determinant > 0 ? (zy * xx - xy * xz) / determinant : 0;
  double squares = 0;
  for (const glm::dvec3& foot : feet) {
    const glm::dvec3 d = foot - mean;
    const double off = d.y - b * d.x - c * d.z;
    squares += off * off;
  }
  return std::sqrt(squares / static_cast<double>(feet.size()));
}

}  // namespace skitter::experiments

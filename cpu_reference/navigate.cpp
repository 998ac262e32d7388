#include "cpu_reference/navigate.h"

#include <limits>
#include <utility>

namespace skitter::reference {

NavigateResult navigate(const Tuning& tuning, const AgentBody& body, const Goal& goal,
                        const NavigateChoices& choices) {
  constexpr double never = std::numeric_limits<double>::infinity();
  NavigateResult result{goal, glm::dvec2(0), never, glm::dvec2(never)};
  if (goal.kind == GoalKind::none) return result;

  const glm::dvec2 position = body.world();
  glm::dvec2 delta = goal.target - position;
  result.arrivalMargin = std::abs(glm::length(delta) - goal.arrivalRadius);
  const bool arrived = choices.arrived >= 0 ? choices.arrived == 1 : glm::length(delta) < goal.arrivalRadius;
  if (goal.kind == GoalKind::cross && arrived) {
    std::swap(result.goal.target, result.goal.otherEnd);
    delta = result.goal.target - position;
  }
  if (goal.kind == GoalKind::point) {
    if (arrived) return result;
    result.desired = goal.speed * std::min(1.0, glm::length(delta) / tuning.slowRadius) * normalized(delta);
  } else {
    result.desired = goal.speed * normalized(delta);
  }

  const glm::dvec2 halfExtent{tuning.halfExtentX, tuning.halfExtentZ};
  for (int axis = 0; axis < 2; ++axis) {
    const double beyond = std::abs(position[axis]) - (halfExtent[axis] - tuning.edgeMargin);
    result.edgeMargin[axis] = std::abs(beyond);
    const bool outward = result.desired[axis] * position[axis] > 0;
    const bool turnsBack =
        choices.turnedBack[axis] >= 0 ? choices.turnedBack[axis] == 1 : beyond > 0 && outward;
    if (turnsBack) result.desired[axis] = -result.desired[axis];
  }
  return result;
}

}  // namespace skitter::reference

#include "cpu_reference/stages/navigate.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace skitter::reference {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

// `choice`, 0 or 1, instead of the rule.
bool decided(bool rule, int choice) { return choice >= 0 ? choice == 1 : rule; }

// At the edge of the map.
void turnBack(const Tuning& tuning, const glm::dvec2& position, const NavigateChoices& choices,
              NavigateResult& result) {
  const glm::dvec2 halfExtent{tuning.halfExtentX, tuning.halfExtentZ};
  for (int axis = 0; axis < 2; ++axis) {
    const double beyond = std::abs(position[axis]) - (halfExtent[axis] - tuning.edgeMargin);
    result.edgeMargin[axis] = std::abs(beyond);
    const bool outward = result.desired[axis] * position[axis] > 0;
    if (decided(beyond > 0 && outward, choices.turnedBack[axis]))
      result.desired[axis] = -result.desired[axis];
  }
}

void steer(const Tuning& tuning, const AgentBody& body, const Goal& goal, const NavigateChoices& choices,
           NavigateResult& result) {
  if (goal.kind == GoalKind::none) return;

  const glm::dvec2 position = body.world();
  if (goal.kind == GoalKind::velocity) {
    // Continuous where it begins to be cut, so no decision.
    const double wanted = glm::length(goal.target);
    result.desired = goal.target * (wanted > goal.speed ? goal.speed / wanted : 1.0);
    return turnBack(tuning, position, choices, result);
  }
  glm::dvec2 delta = goal.target - position;
  result.arrivalMargin = std::abs(glm::length(delta) - goal.arrivalRadius);
  const bool arrived = decided(glm::length(delta) < goal.arrivalRadius, choices.arrived);
  if (goal.kind == GoalKind::cross && arrived) {
    std::swap(result.goal.target, result.goal.otherEnd);
    delta = result.goal.target - position;
  }
  if (goal.kind == GoalKind::point) {
    if (arrived) return;
    result.desired = goal.speed * std::min(1.0, glm::length(delta) / tuning.slowRadius) * normalized(delta);
  } else {
    result.desired = goal.speed * normalized(delta);
  }
  turnBack(tuning, position, choices, result);
}

// Along the field of a goal of kind point; whether there is one. Who is near its stop goes there as without
// one.
bool followField(const Tuning& tuning, const AgentBody& body, const Goal& goal,
                 std::span<const WayField> ways, const NavigateChoices& choices, NavigateResult& result) {
  const auto way =
      std::find_if(ways.begin(), ways.end(), [&](const WayField& each) { return each.goal == goal.target; });
  if (way == ways.end()) return false;
  result.way = followWay(tuning, *way, body.world(), goal.speed, goal.arrivalRadius, choices.way);
  if (result.way->straight) {
    Goal near = goal;
    near.target = way->stop;
    steer(tuning, body, near, choices, result);
  } else {
    result.desired = result.way->desired;
    turnBack(tuning, body.world(), choices, result);
  }
  return true;
}

// To the place of a series, wherever that is now, and past it to the next one. Without a field an agent
// stands.
void followSeries(const Tuning& tuning, const AgentBody& body, const Goal& goal,
                  std::span<const WayField> ways, std::span<const WayPlace> places,
                  const NavigateChoices& choices, NavigateResult& result) {
  const WayPlace& place = places[static_cast<size_t>(goal.otherEnd.x)];
  Goal led = goal;
  led.kind = GoalKind::point;
  led.target = place.at;
  result.goal.target = place.at;
  if (!followField(tuning, body, led, ways, choices, result)) return;
  if (!result.way->passes || place.choices == 0) return;
  const WayNext next = wayNext(place, static_cast<uint32_t>(goal.otherEnd.y));
  result.goal.target = places[next.number].at;
  result.goal.otherEnd = {static_cast<double>(next.number), static_cast<double>(next.draw)};
}

void sleep(const Tuning& tuning, const AgentBody& body, const Rest& rest, const NavigateChoices& choices,
           NavigateResult& result) {
  if (!rest.allowed || rest.edited) return;
  const double speed = glm::length(result.desired), standing = 1e-2 * tuning.legLength;
  result.standMargin = std::abs(speed - standing);
  const bool stands = decided(speed < standing, choices.stands);

  const Gait& gait = rest.gait;
  bool breathedOut = true;
  if (rest.breathes) {
    const double begun = rest.round * tuning.dt / gait.cycle;
    result.breathMargin = std::abs(gait.phase - begun);
    breathedOut = decided(gait.phase < begun, choices.breathedOut);
  }
  const bool feetStand = (gait.lift | gait.reaim | gait.air) == 0;
  result.asleep = stands && body.still >= tuning.sleepTime && feetStand && breathedOut;
}

}  // namespace

NavigateResult navigate(const Tuning& tuning, const AgentBody& body, const Goal& goal, const Rest& rest,
                        const NavigateChoices& choices, std::span<const WayField> ways,
                        std::span<const WayPlace> places) {
  NavigateResult result{goal,      glm::dvec2(0), body.absent, unbounded, glm::dvec2(unbounded),
                        unbounded, unbounded,     {}};
  if (body.absent) return result;
  if (goal.kind == GoalKind::series)
    followSeries(tuning, body, goal, ways, places, choices, result);
  else if (goal.kind != GoalKind::point || !followField(tuning, body, goal, ways, choices, result))
    steer(tuning, body, goal, choices, result);
  sleep(tuning, body, rest, choices, result);
  return result;
}

}  // namespace skitter::reference

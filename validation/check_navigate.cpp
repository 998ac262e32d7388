#include "cpu_reference/stages/avoid.h"
#include "cpu_reference/stages/navigate.h"
#include "cpu_reference/stages/tolerances.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/fields.h"

namespace skitter::validation {
namespace {

namespace tolerance = reference::tolerance;

double cellOf(const Setting& setting) { return setting.ways.front().cell; }

double fieldBound(const Setting& setting, const reference::WayResult& way) {
  return tolerance::wayVelocity(setting.extent, cellOf(setting), way, setting.tuning.slowRadius);
}

// Ties of the way: choices 0 to 31 take one side or the other of each.
void decideWay(const Setting& setting, const reference::WayResult& way, double arrivalRadius, int choice,
               reference::WayChoices& choices) {
  const double cell = cellOf(setting), place = tolerance::wayPlace(setting.extent, cell);
  if (way.straightMargin < tolerance::goalDistance(setting.extent) + 8 * tolerance::roundoff * cell)
    choices.straight = choice & 1;
  if (way.stopMargin < tolerance::wayTime(setting.extent, cell, way.rise, arrivalRadius))
    choices.stops = choice >> 1 & 1;
  if (way.passMargin < tolerance::wayTime(setting.extent, cell, way.rise, 4 * arrivalRadius))
    choices.passes = choice >> 4 & 1;
  for (int axis = 0; axis < 2; ++axis) {
    if ((choice >> (2 + axis) & 1) == 0) continue;
    if (way.lowerMargin[axis] < place) choices.besides[axis] = -1;
    if (way.upperMargin[axis] < place) choices.besides[axis] = 1;
  }
}

Sample compare(const Setting& setting, const Moment& moment, const reference::AgentBody& body,
               const reference::NavigateResult& expected) {
  const reference::Goal got = goalOf(moment.after, moment.agent);
  const glm::dvec2 desired = desiredOf(moment.after, moment.agent);
  Sample sample;
  sample.finite("goal", records(moment.after.goal, moment.agent, shared::GOAL_STRIDE));
  sample.finite("steer", records(moment.after.steer, moment.agent, shared::STEER_STRIDE));
  compareFields(expected.goal, got, sample);
  sample.same("goal kind", static_cast<double>(expected.goal.kind), static_cast<double>(got.kind));
  const bool given = expected.goal.kind == reference::GoalKind::velocity;
  const double speed = std::max(given ? glm::length(expected.desired) : expected.goal.speed, 1e-6);
  const auto& way = expected.way;
  const double distance = way ? way->away : glm::length(expected.goal.target - body.world());
  sample.same("asleep", expected.asleep, records(moment.after.steer, moment.agent, shared::STEER_STRIDE)[2]);
  sample.compare("desired velocity / speed", glm::length(desired - expected.desired) / speed,
                 way && !way->straight ? fieldBound(setting, *way)
                 : given               ? 8 * tolerance::roundoff
                         : tolerance::desiredVelocity(setting.extent, distance, setting.tuning.slowRadius),
                 {expected.desired, 0, 0}, {desired, 0, 0});
  return sample;
}

}  // namespace

reference::Rest restOf(const Setting& setting, const Moment& moment) {
  return {.gait = gaitOf(moment.before, moment.agent),
          .allowed = moment.after.sleep,
          .edited = moment.after.watched,
          .breathes = setting.controller == Controller::adaptive,
          .round = moment.after.avoid.empty() ? 1 : reference::roundTicks(setting.tuning.dt)};
}

void checkNavigate(const Setting& setting, const Moment& moment, Judge& judge) {
  if (setting.forage) return checkForage(setting, moment, judge);
  const reference::Tuning& tuning = setting.tuning;
  const reference::AgentBody body = bodyOf(moment.before, moment.agent);
  const reference::Goal goal = goalOf(moment.before, moment.agent);
  const reference::Rest rest = restOf(setting, moment);
  const auto run = [&](const reference::NavigateChoices& choices) {
    return reference::navigate(tuning, body, goal, rest, choices, setting.ways, setting.wayPlaces);
  };
  const reference::NavigateResult result = run({});
  const Sample sample = compare(setting, moment, body, result);
  if (sample.passes()) return judge.add(moment.n, moment.number(), -1, sample);

  const double near = tolerance::goalDistance(setting.extent);
  const double breath = tolerance::breathedOut(tuning, rest.round, rest.gait);
  // A sleeper decides again and again what it fell asleep by: that is one tie.
  const bool slept = mayRest(moment.before, moment.agent) && mayRest(moment.after, moment.agent);
  for (int choice = 0; choice < (result.way ? 1024 : 32); ++choice) {
    reference::NavigateChoices choices;
    if (result.way) decideWay(setting, *result.way, goal.arrivalRadius, choice >> 5, choices.way);
    const auto bit = [&](int i) { return choice >> i & 1; };
    if (result.arrivalMargin < near) choices.arrived = bit(0);
    for (int axis = 0; axis < 2; ++axis) {
      if (result.edgeMargin[axis] < near) choices.turnedBack[axis] = bit(1 + axis);
    }
    const reference::NavigateResult steered = run(choices);
    double stands = tolerance::stands(setting.extent, glm::length(steered.desired), tuning.slowRadius,
                                      1e-2 * tuning.legLength);
    if (steered.way && !steered.way->straight) stands += goal.speed * fieldBound(setting, *steered.way);
    if (steered.standMargin < stands) choices.stands = bit(3);
    if (steered.breathMargin < breath) choices.breathedOut = bit(4);
    const Sample other = compare(setting, moment, body, run(choices));
    if (other.passes()) return judge.add(moment.n, moment.number(), -1, other, !slept);
  }
  judge.add(moment.n, moment.number(), -1, sample);
}

}  // namespace skitter::validation

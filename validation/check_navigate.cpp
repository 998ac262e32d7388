#include "cpu_reference/stages/navigate.h"
#include "cpu_reference/stages/tolerances.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/fields.h"

namespace skitter::validation {
namespace {

namespace tolerance = reference::tolerance;

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
  const double distance = glm::length(expected.goal.target - body.world());
  sample.same("asleep", expected.asleep, records(moment.after.steer, moment.agent, shared::STEER_STRIDE)[2]);
  sample.compare("desired velocity / speed", glm::length(desired - expected.desired) / speed,
                 given ? 8 * tolerance::roundoff
                       : tolerance::desiredVelocity(setting.extent, distance, setting.tuning.slowRadius),
                 {expected.desired, 0, 0}, {desired, 0, 0});
  return sample;
}

}  // namespace

void checkNavigate(const Setting& setting, const Moment& moment, Judge& judge) {
  const reference::Tuning& tuning = setting.tuning;
  const reference::AgentBody body = bodyOf(moment.before, moment.agent);
  const reference::Goal goal = goalOf(moment.before, moment.agent);
  const reference::Rest rest{.gait = gaitOf(moment.before, moment.agent),
                             .allowed = moment.after.sleep,
                             .edited = moment.after.watched,
                             .breathes = setting.controller == Controller::adaptive};
  const auto run = [&](const reference::NavigateChoices& choices) {
    return reference::navigate(tuning, body, goal, rest, choices);
  };
  const reference::NavigateResult result = run({});
  const Sample sample = compare(setting, moment, body, result);
  if (sample.passes()) return judge.add(moment.n, moment.number(), -1, sample);

  const double near = tolerance::goalDistance(setting.extent);
  const double breath = tolerance::breathedOut(tuning, rest.gait);
  // A sleeper decides again and again what it fell asleep by: that is one tie.
  const bool slept = mayRest(moment.before, moment.agent) && mayRest(moment.after, moment.agent);
  for (int choice = 0; choice < 32; ++choice) {
    reference::NavigateChoices choices;
    const auto bit = [&](int i) { return choice >> i & 1; };
    if (result.arrivalMargin < near) choices.arrived = bit(0);
    for (int axis = 0; axis < 2; ++axis) {
      if (result.edgeMargin[axis] < near) choices.turnedBack[axis] = bit(1 + axis);
    }
    const reference::NavigateResult steered = run(choices);
    const double stands = tolerance::stands(setting.extent, glm::length(steered.desired), tuning.slowRadius,
                                            1e-2 * tuning.legLength);
    if (steered.standMargin < stands) choices.stands = bit(3);
    if (steered.breathMargin < breath) choices.breathedOut = bit(4);
    const Sample other = compare(setting, moment, body, run(choices));
    if (other.passes()) return judge.add(moment.n, moment.number(), -1, other, !slept);
  }
  judge.add(moment.n, moment.number(), -1, sample);
}

}  // namespace skitter::validation

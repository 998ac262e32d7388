#include <algorithm>
#include <array>

#include "cpu_reference/heightfield.h"
#include "cpu_reference/stages/react.h"
#include "cpu_reference/stages/tolerances.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/fields.h"

namespace skitter::validation {
namespace {

namespace tolerance = reference::tolerance;
using reference::ReactDecision, reference::Reaction;

// How far the number behind each decision may be off.
std::array<double, reference::reactDecisions> decisionBounds(const Setting& setting, const Moment& moment,
                                                             const tolerance::ReactBounds& bound) {
  std::array<double, reference::reactDecisions> bounds{};
  const auto set = [&](ReactDecision decision, double most) { bounds[static_cast<size_t>(decision)] = most; };
  // The ground below a landing, as gait sees it.
  double ground = 0;
  const reference::AgentBody body = bodyOf(moment.before, moment.agent);
  for (size_t l = 0; moment.after.watched && l < static_cast<size_t>(setting.legs); ++l) {
    const reference::Step step = stepOf(moment.before, moment.agent * static_cast<size_t>(setting.legs) + l);
    const glm::dvec3 landing = step.relative(step.landing, body);
    const glm::dvec2 at = body.world() + glm::dvec2(landing.x, landing.z);
    ground = std::max(ground, tolerance::height(reference::reliefNear(setting.heights, at.x, at.y),
                                                setting.extent, tolerance::relative) +
                                  8 * tolerance::roundoff * tolerance::stepHeight(step, body));
  }
  const double dt = setting.tuning.dt;
  set(ReactDecision::losesGround, ground);
  set(ReactDecision::isCaught, bound.reach);
  set(ReactDecision::falls, bound.time);
  set(ReactDecision::isFree, bound.velocity);
  set(ReactDecision::hasRisen, 16 * tolerance::roundoff * setting.tuning.bodyHeight);
  set(ReactDecision::isBlocked, 2 * bound.floor + setting.tuning.wallSlope * dt * bound.velocity);
  set(ReactDecision::touches, bound.floor + 8 * tolerance::roundoff * dt);
  set(ReactDecision::isSlow, bound.velocity);
  set(ReactDecision::isCalm, bound.tiltRate);
  set(ReactDecision::hasLain, bound.time);
  set(ReactDecision::isUpright, bound.tilt);
  return bounds;
}

Sample compare(const Setting& setting, const Moment& moment, const reference::ReactResult& result,
               const tolerance::ReactBounds& bound) {
  const Reaction& expected = result.reaction;
  const Reaction got = reactionOf(moment.after, moment.agent);
  const double unit = setting.tuning.legLength, dt = setting.tuning.dt;
  Sample sample;
  sample.finite("reaction", records(moment.after.reaction, moment.agent, shared::REACTION_STRIDE));
  compareFields(expected, got, sample);
  sample.same("phase", static_cast<double>(expected.phase), static_cast<double>(got.phase));
  const auto scalar = [&](const char* quantity, double want, double found, double bounded) {
    sample.compare(quantity, std::abs(want - found), bounded, {want, 0, 0, 0}, {found, 0, 0, 0});
  };
  scalar("seconds in the phase", expected.clock, got.clock, bound.time);
  scalar("seconds for a fall to begin", expected.disturbed, got.disturbed, bound.time);
  scalar("seconds out of reach, or contact", expected.over, got.over, bound.time);
  scalar("seconds down", expected.down, got.down, bound.time);
  scalar("seconds down before", expected.downBefore, got.downBefore, bound.time);
  scalar("fold", expected.fold, got.fold, 8 * tolerance::roundoff);
  sample.compare("velocity, m/s", glm::length(expected.velocity - got.velocity), bound.velocity,
                 {expected.velocity, 0, 0}, {got.velocity, 0, 0});
  // A velocity upward is a height over a tick.
  scalar("rise in a tick / leg length", expected.sink * dt / unit, got.sink * dt / unit,
         (bound.floor + 8 * tolerance::roundoff * dt * (1 + std::abs(expected.sink))) / unit);
  scalar("drop / leg length", expected.drop / unit, got.drop / unit,
         16 * tolerance::roundoff * setting.tuning.bodyHeight / unit);
  sample.compare("direction of the fall", glm::length(expected.way - got.way), bound.way,
                 {expected.way, 0, 0}, {got.way, 0, 0});
  scalar("tilt, rad", expected.tilt, got.tilt, bound.tilt);
  scalar("rate of the tilt, rad/s", expected.tiltRate, got.tiltRate, bound.tiltRate);
  sample.compare("axis of the ground", glm::length(expected.ground - got.ground), bound.ground,
                 {expected.ground, 0}, {got.ground, 0});
  return sample;
}

}  // namespace

void checkReact(const Setting& setting, const Moment& moment, Judge& judge) {
  const reference::AgentBody body = bodyOf(moment.before, moment.agent);
  const Reaction before = reactionOf(moment.before, moment.agent);
  std::vector<reference::Step> steps;
  std::vector<double> misses;
  const size_t legs = static_cast<size_t>(setting.legs);
  for (size_t l = 0; l < legs; ++l) {
    steps.push_back(moment.stepOf(moment.before, moment.agent * legs + l));
    misses.push_back(missOf(moment.before, moment.agent, l, setting.legs, moment.n - moment.span));
  }
  const uint32_t idleBefore = gaitOf(moment.before, moment.agent).idle;
  const auto run = [&](reference::ReactFlips flips) {
    return reference::react(setting.tuning, setting.heights, setting.creature, body, before, steps, misses,
                            moment.now(), pushOf(moment.after, moment.agent, moment.n),
                            moment.after.watched ? &setting.heights : nullptr, idleBefore, flips);
  };
  const auto judged = [&](const reference::ReactResult& result, tolerance::ReactBounds& bound) {
    bound = tolerance::react(setting.tuning, setting.heights, setting.extent, setting.creature, body, before,
                             result);
    return compare(setting, moment, result, bound);
  };
  const reference::ReactResult result = run(0);
  tolerance::ReactBounds bound{};
  const Sample sample = judged(result, bound);
  if (sample.passes()) return judge.add(moment.n, moment.number(), -1, sample);
  const auto bounds = decisionBounds(setting, moment, bound);
  for (size_t d = 0; d < bounds.size(); ++d) {
    if (!(result.margins[d] <= bounds[d])) continue;
    tolerance::ReactBounds ignored{};
    const Sample other = judged(run(1u << d), ignored);
    if (other.passes()) return judge.add(moment.n, moment.number(), -1, other, true);
  }
  judge.add(moment.n, moment.number(), -1, sample);
}

void checkPushed(const Setting& setting, const Moment& moment, const glm::dvec2& push, Judge& judge) {
  const Reaction before = reactionOf(moment.before, moment.agent);
  const reference::ReactResult expected{
      .reaction = reference::pushed(setting.tuning, setting.creature, before, push), .margins = {}};
  // Nothing but the velocity is computed, and it is by a sum and a quotient.
  tolerance::ReactBounds bound{};
  bound.velocity = 4 * tolerance::roundoff * (glm::length(before.velocity) + glm::length(push));
  judge.add(moment.n, moment.number(), -1, compare(setting, moment, expected, bound));
}

}  // namespace skitter::validation

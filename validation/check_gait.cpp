#include <bit>

#include "cpu_reference/heightfield.h"
#include "cpu_reference/stages/gait.h"
#include "cpu_reference/stages/tolerances.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/fields.h"

namespace skitter::validation {
namespace {

namespace tolerance = reference::tolerance;

double phaseDifference(double a, double b) {
  const double d = std::abs(a - b);
  return std::min(d, std::abs(1 - d));
}

// How near to falling the other way the decisions behind leg `l`'s bit were, relative to their tolerance: its
// own, its neighbours' (who may have gone first), and which leg must lift.
double liftTie(const Setting& setting, const reference::GaitResult& result,
               const tolerance::GaitBounds& bound, size_t l, double settleBound) {
  double nearest =
      std::min(result.mustMargin / std::max(bound.length, bound.ground), result.settleMargin / settleBound);
  for (size_t m = 0; m < result.legs.size(); ++m) {
    const bool counts = m == l || (setting.creature.limbs[l].neighbours >> m & 1u) != 0;
    if (!counts || !result.legs[m].planted) continue;
    nearest = std::min(
        {nearest, result.legs[m].wantsMargin / bound.length, result.legs[m].windowMargin / bound.window});
  }
  return nearest;
}

double reaimTie(const reference::GaitResult& result, const tolerance::GaitBounds& bound, size_t l) {
  const reference::LegDecision& leg = result.legs[l];
  return std::min({leg.reaimMargin / bound.length, leg.reaimProgressMargin / (6 * tolerance::roundoff),
                   leg.movedMargin / bound.ground});
}

// The bound of the ground above a foot or its way: the steepest cells near any landing, seen from a point of
// a spline.
double groundBound(const Setting& setting, const Moment& moment, const reference::AgentBody& body) {
  double bound = 0;
  const glm::dvec2 position = body.world();
  for (size_t l = 0; l < static_cast<size_t>(setting.legs); ++l) {
    const reference::Step step = stepOf(moment.before, moment.agent * static_cast<size_t>(setting.legs) + l);
    for (const glm::dvec3& point : {step.landing, step.liftOff, (step.landing + step.liftOff) / 2.0}) {
      const glm::dvec3 p = step.relative(point, body);
      const reference::Relief relief =
          reference::reliefNear(setting.heights, position.x + p.x, position.y + p.z);
      bound =
          std::max(bound, tolerance::height(relief, setting.extent, tolerance::footAside(step, body, false)));
    }
  }
  return bound + 16 * tolerance::roundoff * std::max(1.0, std::abs(body.y));
}

struct GaitVerdict {
  Sample sample;
  bool tie = false;
};

GaitVerdict compare(const Setting& setting, const Moment& moment, const reference::GaitResult& result) {
  const reference::Gait got = gaitOf(moment.after, moment.agent);
  const reference::Gait& expected = result.gait;
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const double forecast =
      setting.tuning.legLength + (body.surfaceSpeed + 1) * expected.cycle + setting.creature.hurry();
  auto bound = tolerance::gait(setting.tuning, expected, setting.creature.groups, forecast);
  if (moment.after.watched) bound.ground = groundBound(setting, moment, body);
  const double settleBound = 4 * tolerance::roundoff * (1 + setting.tuning.settleTime);

  GaitVerdict verdict;
  Sample& sample = verdict.sample;
  sample.finite("gait", records(moment.after.gait, moment.agent, shared::GAIT_STRIDE));
  sample.compare("phase", phaseDifference(expected.phase, got.phase), bound.phase, {expected.phase, 0, 0, 0},
                 {got.phase, 0, 0, 0});
  sample.compare("phase outside [0, 1)", got.phase >= 0 && got.phase < 1 ? 0 : 1, 0,
                 {expected.phase, 0, 0, 0}, {got.phase, 0, 0, 0});
  compareFields(expected, got, sample);
  sample.compare(
      "half stride / leg length", std::abs(expected.halfStride - got.halfStride) / setting.tuning.legLength,
      bound.halfStride / setting.tuning.legLength, {expected.halfStride, 0, 0, 0}, {got.halfStride, 0, 0, 0});
  sample.compare("cycle, s", std::abs(expected.cycle - got.cycle), bound.cycle, {expected.cycle, 0, 0, 0},
                 {got.cycle, 0, 0, 0});

  const uint32_t lift = expected.lift ^ got.lift, reaim = expected.reaim ^ got.reaim;
  const uint32_t legs = setting.legs >= 32 ? ~0u : (1u << setting.legs) - 1;
  sample.same("mask bits beyond the legs", 0, (got.lift | got.reaim) & ~legs);
  // Legs that carry again do both; they hang in the air.
  const uint32_t rising = expected.lift & expected.reaim;
  sample.same("legs that lift while in the air", rising, got.lift & expected.air);
  sample.same("legs aimed anew while planted", 0, got.reaim & ~expected.air);
  sample.same("legs that do not carry", expected.idle, got.idle);
  for (size_t l = 0; l < result.legs.size(); ++l) {
    if ((lift >> l & 1u) != 0) {
      sample.compare("lift mask, decision margin / its bound",
                     liftTie(setting, result, bound, l, settleBound), 1,
                     {expected.lift, static_cast<double>(l), 0, 0}, {got.lift, static_cast<double>(l), 0, 0});
    }
    if ((reaim >> l & 1u) != 0) {
      sample.compare("re-aim mask, decision margin / its bound", reaimTie(result, bound, l), 1,
                     {expected.reaim, static_cast<double>(l), 0, 0},
                     {got.reaim, static_cast<double>(l), 0, 0});
    }
  }
  verdict.tie = lift != 0 || reaim != 0;
  return verdict;
}

}  // namespace

void checkGait(const Setting& setting, const Moment& moment, Judge& judge) {
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const double phase = gaitOf(moment.before, moment.agent).phase;
  std::vector<reference::Step> steps;
  const size_t legs = static_cast<size_t>(setting.legs);
  std::vector<double> misses;
  for (size_t l = 0; l < legs; ++l) {
    steps.push_back(moment.stepOf(moment.before, moment.agent * legs + l));
    misses.push_back(missOf(moment.before, moment.agent, l, setting.legs, moment.n - moment.span));
  }
  const uint32_t idleBefore = gaitOf(moment.before, moment.agent).idle;
  const auto run = [&](const reference::GaitChoices& choices) {
    return reference::gait(setting.tuning, setting.creature, body, phase, steps, misses, moment.now(),
                           choices, moment.after.watched ? &setting.heights : nullptr, idleBefore);
  };
  const reference::GaitResult result = run({});
  const GaitVerdict verdict = compare(setting, moment, result);
  if (!verdict.sample.passes()) {
    const auto bound = tolerance::gait(setting.tuning, result.gait, setting.creature.groups, 0);
    const double duration = gaitOf(moment.after, moment.agent).duration;
    if (result.durationMargin < bound.duration && std::abs(duration - result.gait.duration) == 1) {
      const GaitVerdict other = compare(setting, moment, run({duration}));
      if (other.sample.passes()) return judge.add(moment.n, moment.number(), -1, other.sample, true);
    }
  }
  judge.add(moment.n, moment.number(), -1, verdict.sample, verdict.tie);
}

}  // namespace skitter::validation

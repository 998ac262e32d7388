#include "cpu_reference/stages/gait_loop.h"
#include "cpu_reference/stages/tolerances.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/fields.h"

namespace skitter::validation {
namespace {

namespace tolerance = reference::tolerance;

Sample compare(const Setting& setting, const Moment& moment, const reference::Gait& expected) {
  const reference::Gait got = gaitOf(moment.after, moment.agent);
  const auto bound = tolerance::gait(setting.tuning, expected, setting.creature.groups, 0);
  Sample sample;
  sample.finite("gait", records(moment.after.gait, moment.agent, shared::GAIT_STRIDE));
  const double apart = std::abs(expected.phase - got.phase);
  sample.compare("phase", std::min(apart, std::abs(1 - apart)), bound.phase, {expected.phase, 0, 0, 0},
                 {got.phase, 0, 0, 0});
  sample.compare("phase outside [0, 1)", got.phase >= 0 && got.phase < 1 ? 0 : 1, 0,
                 {expected.phase, 0, 0, 0}, {got.phase, 0, 0, 0});
  compareFields(expected, got, sample);
  sample.compare(
      "half stride / leg length", std::abs(expected.halfStride - got.halfStride) / setting.tuning.legLength,
      bound.halfStride / setting.tuning.legLength, {expected.halfStride, 0, 0, 0}, {got.halfStride, 0, 0, 0});
  sample.compare("cycle, s", std::abs(expected.cycle - got.cycle), bound.cycle, {expected.cycle, 0, 0, 0},
                 {got.cycle, 0, 0, 0});
  sample.same("lift mask", 0, got.lift);
  sample.same("re-aim mask", 0, got.reaim);
  sample.same("legs that do not carry", 0, got.idle);
  return sample;
}

}  // namespace

void checkLoopGait(const Setting& setting, const Moment& moment, Judge& judge) {
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const double phase = gaitOf(moment.before, moment.agent).phase;
  const auto run = [&](const std::optional<double>& duration) {
    return reference::loopGait(setting.tuning, setting.creature.groups, body, phase, duration,
                               setting.creature.slowest());
  };
  const reference::LoopGaitResult result = run({});
  const Sample sample = compare(setting, moment, result.gait);
  const double duration = gaitOf(moment.after, moment.agent).duration;
  const auto bound = tolerance::gait(setting.tuning, result.gait, setting.creature.groups, 0);
  if (!sample.passes() && result.durationMargin < bound.duration &&
      std::abs(duration - result.gait.duration) == 1) {
    const Sample other = compare(setting, moment, run(duration).gait);
    if (other.passes()) return judge.add(moment.n, moment.number(), -1, other, true);
  }
  judge.add(moment.n, moment.number(), -1, sample);
}

}  // namespace skitter::validation

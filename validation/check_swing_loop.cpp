#include "cpu_reference/stages/swing_loop.h"
#include "cpu_reference/stages/tolerances.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/fields.h"

namespace skitter::validation {

void checkLoopSwing(const Setting& setting, const Moment& moment, Judge& judge) {
  namespace tolerance = reference::tolerance;
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const reference::Gait gait = gaitOf(moment.after, moment.agent);
  const size_t legs = static_cast<size_t>(setting.legs);
  const double unit = setting.tuning.legLength;
  for (size_t l = 0; l < legs; ++l) {
    const size_t leg = moment.agent * legs + l;
    const reference::Limb& limb = setting.creature.limbs[l];
    const reference::LoopFoot expected =
        reference::loopSwing(setting.tuning, setting.creature.groups, limb, body, gait);
    const reference::Foot got = footOf(moment.after, leg);
    const auto bound = tolerance::loopSwing(setting.tuning, limb, body, gait);

    Sample sample;
    sample.finite("foot", records(moment.after.foot, leg, shared::FOOT_STRIDE));
    if (!limb.carries) {
      sample.compare("target of a leg that does not carry", glm::length(got.target), 0, {}, {got.target, 0});
      sample.same("progress of a leg that does not carry", 0, got.progress);
      judge.add(moment.n, moment.number(), static_cast<int>(l), sample);
      continue;
    }
    compareFields(expected.foot, got, sample);
    // A loop is closed and has no corner where a foot lifts or lands: only which it is may be in doubt there.
    const bool stands = expected.foot.progress >= 1, tie = stands != (got.progress >= 1);
    if (tie) {
      const double swingTime = limb.stepTicks(gait.duration) * setting.tuning.dt;
      const double toLanding = std::min(expected.theta, 1 - expected.theta) * gait.cycle / swingTime;
      sample.compare("stance, shares of a swing from its edge / bound",
                     std::min(std::abs(expected.flown), toLanding) / bound.flown, 1,
                     {expected.foot.progress, expected.flown, 0, 0}, {got.progress, 0, 0, 0});
    } else {
      sample.compare("progress", std::abs(expected.foot.progress - got.progress), bound.flown,
                     {expected.foot.progress, 0, 0, 0}, {got.progress, 0, 0, 0});
    }
    sample.compare("target / leg length", glm::length(expected.foot.target - got.target) / unit,
                   bound.place / unit, {expected.foot.target, 0}, {got.target, 0});
    judge.add(moment.n, moment.number(), static_cast<int>(l), sample, tie);
  }
}

}  // namespace skitter::validation

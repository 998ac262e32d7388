#include "cpu_reference/stages/swing_key_poses.h"
#include "cpu_reference/stages/tolerances_key_poses.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/fields.h"

namespace skitter::validation {

void checkKeyPoseSwing(const Setting& setting, const Moment& moment, Judge& judge) {
  namespace tolerance = reference::tolerance;
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const double phase = gaitOf(moment.after, moment.agent).phase;
  const size_t legs = static_cast<size_t>(setting.legs);
  const double unit = setting.tuning.legLength;
  for (size_t l = 0; l < legs; ++l) {
    const size_t leg = moment.agent * legs + l;
    const reference::Limb& limb = setting.creature.limbs[l];
    const auto directions = chainOf(moment.before, leg, setting.bones).directions;
    const auto rates = springOf(moment.before, leg, setting.bones);
    const reference::SprungLeg expected =
        reference::poseSwing(setting.tuning, setting.keyPoses, limb, l, body, phase, directions, rates);
    const auto bound = tolerance::poseSwing(setting.tuning, setting.keyPoses, limb, l, body, directions,
                                            rates, expected, static_cast<double>(moment.span));
    const reference::Foot foot = footOf(moment.after, leg);
    const reference::Chain chain = chainOf(moment.after, leg, setting.bones);
    const auto gotRates = springOf(moment.after, leg, setting.bones);

    Sample sample;
    sample.finite("foot", records(moment.after.foot, leg, shared::FOOT_STRIDE));
    sample.finite("chain", records(moment.after.chain, leg, shared::chainStride(setting.bones)));
    sample.finite("spring", records(moment.after.spring, leg, shared::chainStride(setting.bones)));
    compareFields(expected.foot, foot, sample);
    for (size_t i = 0; i < limb.bones.size(); ++i) {
      const glm::dvec2 &want = expected.chain.directions[i], &found = chain.directions[i];
      sample.compare("direction", glm::length(want - found), bound.directions[i], {want, i, 0},
                     {found, i, 0});
      sample.compare("rate of a direction, 1/s", glm::length(expected.rates[i] - gotRates[i]), bound.rates[i],
                     {expected.rates[i], i, 0}, {gotRates[i], i, 0});
    }
    sample.compare("tip / leg length", glm::length(expected.chain.tip - chain.tip) / unit, bound.tip / unit,
                   {expected.chain.tip, 0}, {chain.tip, 0});
    sample.compare("target / leg length", glm::length(expected.foot.target - foot.target) / unit,
                   bound.tip / unit, {expected.foot.target, 0}, {foot.target, 0});
    const bool tie = expected.foot.progress != foot.progress;
    if (tie && (foot.progress == 1 || foot.progress == 0.5)) {
      sample.compare("stance, of its nearest edge / bound",
                     std::min(expected.stanceMargin / bound.stance, expected.walkMargin / bound.walking), 1,
                     {expected.foot.progress, 0, 0, 0}, {foot.progress, 0, 0, 0});
    } else {
      sample.same("stance", expected.foot.progress, foot.progress);
    }
    sample.same("reach error", 0, chain.reachError);
    judge.add(moment.n, moment.number(), static_cast<int>(l), sample, tie);
  }
}

}  // namespace skitter::validation

#include "cpu_reference/stages/swing_clip.h"

#include "cpu_reference/stages/tolerances_clip.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/clip_leg.h"
#include "validation/convert.h"
#include "validation/convert_clip.h"
#include "validation/fields.h"

namespace skitter::validation {

void checkClipSwing(const Setting& setting, const Moment& moment, Judge& judge) {
  namespace tolerance = reference::tolerance;
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const reference::Play play = playOf(moment.after, moment.agent, setting.clips);
  const size_t legs = static_cast<size_t>(setting.legs);
  const double unit = setting.tuning.legLength;
  for (size_t l = 0; l < legs; ++l) {
    const size_t leg = moment.agent * legs + l;
    const reference::Limb& limb = setting.creature.limbs[l];
    const reference::ClipLeg clipLeg = reference::clipLeg(setting.clips, limb, l, play);
    const reference::ClipFoot expected = reference::clipSwing(setting.clips, limb, l, body, play);
    const reference::Foot foot = footOf(moment.after, leg);
    const reference::Chain chain = chainOf(moment.after, leg, setting.bones);
    const ClipLegBounds bounds = boundsOf(setting, limb, l, play, clipLeg);

    Sample sample;
    sample.finite("foot", records(moment.after.foot, leg, shared::FOOT_STRIDE));
    sample.finite("chain", records(moment.after.chain, leg, shared::chainStride(setting.bones)));
    compareFields(expected.foot, foot, sample);
    const double place = bounds.joints.back() + tolerance::rotated(glm::length(expected.foot.target));
    sample.compare("foot / leg length", glm::length(expected.foot.target - foot.target) / unit, place / unit,
                   {expected.foot.target, 0}, {foot.target, 0});
    sample.compare("tip / leg length", glm::length(expected.chain.tip - chain.tip) / unit, place / unit,
                   {expected.chain.tip, 0}, {chain.tip, 0});
    sample.same("stance", expected.foot.progress, foot.progress);
    compareDirections(clipLeg, bounds, chain.directions, sample);
    sample.same("reach error", 0, chain.reachError);
    judge.add(moment.n, moment.number(), static_cast<int>(l), sample);
  }
}

}  // namespace skitter::validation

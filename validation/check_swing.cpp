#include "cpu_reference/heightfield.h"
#include "cpu_reference/stages/hurt.h"
#include "cpu_reference/stages/react.h"
#include "cpu_reference/stages/swing.h"
#include "cpu_reference/stages/tolerances.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/fields.h"

namespace skitter::validation {

void checkSwing(const Setting& setting, const Moment& moment, Judge& judge) {
  namespace tolerance = reference::tolerance;
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const size_t legs = static_cast<size_t>(setting.legs);
  const double unit = setting.tuning.legLength;
  for (size_t l = 0; l < legs; ++l) {
    const size_t leg = moment.agent * legs + l;
    const reference::Step step = stepOf(moment.after, leg);
    const reference::Limb& limb = setting.creature.limbs[l];
    reference::Foot expected = reference::idleFoot();
    if (limb.carries || limb.folds) expected = reference::swing(step, body, static_cast<double>(moment.n));
    const double way = expected.progress;
    const double fold = limb.folds ? setting.creature.reaction->fold : 0;
    if (limb.folds)
      expected = reference::foldedFoot(setting.tuning, setting.heights, limb.root,
                                       limb.home - setting.creature.shift, body, expected, fold);
    const reference::Foot got = footOf(moment.after, leg);
    Sample sample;
    sample.finite("foot", records(moment.after.foot, leg, shared::FOOT_STRIDE));
    compareFields(expected, got, sample);
    const bool planted = expected.progress >= 1;
    sample.same("planted", planted, got.progress >= 1);
    sample.compare("progress", std::abs(expected.progress - got.progress), 4 * tolerance::roundoff,
                   {expected.progress, 0, 0, 0}, {got.progress, 0, 0, 0});
    double horizontal = tolerance::footAside(step, body, way >= 1),
           vertical = tolerance::footHeight(step, body, way >= 1);
    if (limb.folds) {
      // The place in the model is rotated once, and mixed; then the ground is looked up there.
      const double folded = tolerance::rotated(glm::length(limb.root) + glm::length(limb.home));
      horizontal += folded + 4 * tolerance::roundoff * glm::length(expected.target);
      const glm::dvec2 at = body.world() + glm::dvec2(expected.target.x, expected.target.z);
      vertical = std::max(
          vertical + folded + 4 * tolerance::roundoff * glm::length(expected.target),
          tolerance::height(reference::reliefNear(setting.heights, at.x, at.y), setting.extent, horizontal) +
              8 * tolerance::roundoff * std::max(1.0, std::abs(body.y)));
    }
    const glm::dvec3 apart = got.target - expected.target;
    const glm::dvec4 want{expected.target, 0}, found{got.target, 0};
    sample.compare("target, horizontally / leg length", std::hypot(apart.x, apart.z) / unit,
                   horizontal / unit, want, found);
    sample.compare("target's height / leg length", std::abs(apart.y) / unit, vertical / unit, want, found);
    judge.add(moment.n, moment.number(), static_cast<int>(l), sample);
  }
}

}  // namespace skitter::validation

#include "cpu_reference/stages/hurt.h"
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
    const reference::Foot expected = setting.creature.limbs[l].carries
                                         ? reference::swing(step, body, static_cast<double>(moment.n))
                                         : reference::idleFoot();
    const reference::Foot got = footOf(moment.after, leg);
    Sample sample;
    sample.finite("foot", records(moment.after.foot, leg, shared::FOOT_STRIDE));
    compareFields(expected, got, sample);
    const bool planted = expected.progress >= 1;
    sample.same("planted", planted, got.progress >= 1);
    sample.compare("progress", std::abs(expected.progress - got.progress), 4 * tolerance::roundoff,
                   {expected.progress, 0, 0, 0}, {got.progress, 0, 0, 0});
    const double horizontal = tolerance::footAside(planted);
    const double vertical = tolerance::footHeight(step, body, planted);
    const glm::dvec3 apart = got.target - expected.target;
    const glm::dvec4 want{expected.target, 0}, found{got.target, 0};
    sample.compare("target, horizontally / leg length", std::hypot(apart.x, apart.z) / unit,
                   horizontal / unit, want, found);
    sample.compare("target's height / leg length", std::abs(apart.y) / unit, vertical / unit, want, found);
    judge.add(moment.n, moment.number(), static_cast<int>(l), sample);
  }
}

}  // namespace skitter::validation

#include "cpu_reference/heightfield.h"
#include "cpu_reference/measure.h"
#include "cpu_reference/tolerances.h"
#include "shared/records.h"
#include "validation/checks.h"
#include "validation/convert.h"

namespace skitter::validation {

void checkMeasure(const Setting& setting, const Moment& moment, Judge& judge) {
  namespace tolerance = reference::tolerance;
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const size_t legs = static_cast<size_t>(setting.legs);
  const double unit = setting.tuning.legLength;
  for (size_t l = 0; l < legs; ++l) {
    const size_t leg = moment.agent * legs + l;
    const reference::Limb& limb = setting.creature.limbs[l];
    const reference::Chain chain = chainOf(moment.after, leg, setting.bones);
    const reference::Metric previous = metricOf(moment.before, leg), got = metricOf(moment.after, leg);
    const reference::Metric expected = reference::measure(
        setting.heights, limb, body, stepOf(moment.after, leg), footOf(moment.after, leg), chain, previous);

    Sample sample;
    sample.finite("metric", records(moment.after.metric, leg, shared::METRIC_STRIDE));
    const double vertical = 6 * tolerance::roundoff * (std::abs(body.y) + limb.reach);
    const glm::dvec3 apart = got.previousTip - expected.previousTip;
    const glm::dvec4 want{expected.previousTip, 0}, found{got.previousTip, 0};
    sample.compare("tip, horizontally / leg length", std::hypot(apart.x, apart.z) / unit,
                   tolerance::relative / unit, want, found);
    sample.compare("tip's height / leg length", std::abs(apart.y) / unit, vertical / unit, want, found);

    const auto length = [&](const char* quantity, double e, double g, double bound) {
      const double rounding = 4 * tolerance::roundoff * std::abs(e);
      sample.compare(quantity, std::abs(e - g) / unit, (bound + rounding) / unit, {e, 0, 0, 0}, {g, 0, 0, 0});
    };
    const glm::dvec2 position = body.world();
    const reference::Relief relief =
        reference::reliefNear(setting.heights, position.x + chain.tip.x, position.y + chain.tip.z);
    const double above =
        tolerance::height(relief, setting.extent, 2 * tolerance::roundoff * limb.reach) + vertical;
    length("slip of the stance / leg length", expected.slip, got.slip, 2 * tolerance::relative);
    length("slip over finished stances / leg length", expected.finishedSlip, got.finishedSlip, 0);
    length("penetration / leg length", expected.penetration, got.penetration, above);
    length("float / leg length", expected.floating, got.floating, above);
    length("largest reach error / leg length", expected.largestError, got.largestError, 0);
    sample.compare("largest limit violation, rad", std::abs(expected.largestViolation - got.largestViolation),
                   tolerance::limit, {expected.largestViolation, 0, 0, 0}, {got.largestViolation, 0, 0, 0});
    sample.same("finished stances", expected.finishedStances, got.finishedStances);
    sample.same("ticks", expected.ticks, got.ticks);
    sample.same("stance ticks", expected.stanceTicks, got.stanceTicks);
    judge.add(moment.n, moment.agent, static_cast<int>(l), sample);
  }
}

}  // namespace skitter::validation

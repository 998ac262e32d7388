#include <algorithm>

#include "cpu_reference/stages/footfall.h"
#include "cpu_reference/stages/tolerances.h"
#include "validation/checks.h"
#include "validation/convert.h"

namespace skitter::validation {
namespace {

const Footfall* eventOf(const HerdState& state, size_t agent, size_t leg) {
  const auto key = [](const Footfall& f) { return std::pair<size_t, size_t>(f.agent, f.leg); };
  const auto at =
      std::lower_bound(state.footfalls.begin(), state.footfalls.end(), std::pair(agent, leg),
                       [&](const Footfall& f, const std::pair<size_t, size_t>& k) { return key(f) < k; });
  return at != state.footfalls.end() && key(*at) == std::pair(agent, leg) ? &*at : nullptr;
}

}  // namespace

void checkFootfall(const Setting& setting, const Moment& moment, Judge& judge) {
  namespace tolerance = reference::tolerance;
  const reference::AgentBody was = bodyOf(moment.before, moment.agent),
                             is = bodyOf(moment.after, moment.agent);
  const auto legs = static_cast<size_t>(setting.legs);
  for (size_t l = 0; l < legs; ++l) {
    const size_t leg = moment.agent * legs + l;
    const auto expected = reference::footfall(
        {was, footOf(moment.before, leg).progress, chainOf(moment.before, leg, setting.bones).tip},
        {is, footOf(moment.after, leg).progress, chainOf(moment.after, leg, setting.bones).tip},
        setting.tuning.dt);
    const Footfall* got = eventOf(moment.after, moment.number(), l);
    Sample sample;
    sample.same("touched down", expected.has_value(), got != nullptr);
    if (expected && got != nullptr) {
      const glm::dvec3 place(got->place);
      const glm::dvec4 want{expected->place, expected->speed}, found{place, double{got->speed}};
      sample.same("tick", static_cast<double>(moment.n), static_cast<double>(got->tick));
      // A tip is added to its body in the tile (2 local at most, heights by their own size) and then to the
      // tile.
      const double height =
          2 * tolerance::roundoff * (std::abs(expected->place.y) + setting.tuning.legLength);
      const double apart = 2 * tolerance::local + tolerance::roundoff * setting.extent + height;
      sample.compare("place / leg length", glm::length(place - expected->place) / setting.tuning.legLength,
                     2 * apart / setting.tuning.legLength, want, found);
      // Two such tips, each err in three coordinates; the length and the division round six times.
      const double way = 2 * (2 * std::sqrt(2.0) * tolerance::local + height);
      sample.compare("speed (m/s)", std::abs(double{got->speed} - expected->speed),
                     way / setting.tuning.dt + 6 * tolerance::roundoff * expected->speed, want, found);
    }
    judge.add(moment.n, moment.number(), static_cast<int>(l), sample);
  }
}

}  // namespace skitter::validation

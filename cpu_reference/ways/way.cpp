#include "cpu_reference/ways/way.h"

#include <algorithm>
#include <cmath>

namespace skitter::reference {
namespace {

// Cells from a stop within which agents go straight.
constexpr double straightCells = 1.25;

// Arrival radii of time to a place of a series at which an agent goes on.
constexpr double passedRadii = 4;

bool taken(bool rule, int choice) { return choice >= 0 ? choice == 1 : rule; }

}  // namespace

// A linear congruential generator of full period, modulo 2^24 (Knuth, The Art of Computer Programming 2,
// 3.2.1.2, theorem A): the factor less 1 is a multiple of 4, the step is odd.
WayNext wayNext(const WayPlace& place, uint32_t draw) {
  constexpr uint64_t factor = 1140671485, step = 12820163, modulus = 1 << 24;
  const uint64_t drawn = (uint64_t{draw} * factor + step) % modulus;
  return {place.first + static_cast<size_t>(drawn * place.choices / modulus), static_cast<uint32_t>(drawn)};
}

WayResult followWay(const Tuning& tuning, const WayField& way, const glm::dvec2& position, double speed,
                    double arrivalRadius, const WayChoices& choices) {
  WayResult result;
  result.away = glm::length(way.stop - position);
  result.straightMargin = std::abs(result.away - straightCells * way.cell);
  result.straight = taken(result.away < straightCells * way.cell, choices.straight);
  result.passes = result.straight;
  if (result.straight) return result;

  const glm::dvec2 last(static_cast<double>(way.columns) - 1, static_cast<double>(way.rows) - 1);
  const glm::dvec2 u = glm::clamp((position - way.origin) / way.cell - 0.5, glm::dvec2(0), last);
  glm::dvec2 around = glm::min(glm::floor(u), last - 1.0);
  result.lowerMargin = u - around;
  result.upperMargin = 1.0 - result.lowerMargin;
  around = glm::clamp(around + glm::dvec2(choices.besides), glm::dvec2(0), last - 1.0);
  const glm::dvec2 f = u - around;
  const size_t at = static_cast<size_t>(around.y) * way.columns + static_cast<size_t>(around.x);
  const double t00 = way.times[at], t10 = way.times[at + 1];
  const double t01 = way.times[at + way.columns], t11 = way.times[at + way.columns + 1];
  const double time = (1 - f.y) * ((1 - f.x) * t00 + f.x * t10) + f.y * ((1 - f.x) * t01 + f.x * t11);
  const glm::dvec2 gradient((1 - f.y) * (t10 - t00) + f.y * (t11 - t01),
                            (1 - f.x) * (t01 - t00) + f.x * (t11 - t10));
  const double steepness = std::max(glm::length(gradient), 1e-6);
  result.rise =
      std::max({std::abs(t10 - t00), std::abs(t11 - t01), std::abs(t01 - t00), std::abs(t11 - t10)});
  result.turning = std::abs(t11 - t01 - t10 + t00) / steepness;
  result.magnified = result.rise / steepness;
  result.stopMargin = std::abs(time - arrivalRadius);
  result.passMargin = std::abs(time - passedRadii * arrivalRadius);
  result.passes = taken(time < passedRadii * arrivalRadius, choices.passes);
  if (!taken(time < arrivalRadius, choices.stops))
    result.desired = -speed * std::min(1.0, time / tuning.slowRadius) * gradient / steepness;
  return result;
}

}  // namespace skitter::reference

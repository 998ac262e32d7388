#include "cpu_reference/ways/way.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cpu_reference/ways/grid.h"

namespace skitter::reference {
namespace {

// Cells from a stop within which agents go straight.
constexpr double straightCells = 1.25;

// Arrival radii of time to a place of a series at which an agent goes on.
constexpr double passedRadii = 4;

// Cells by which what is impassable seems later than what is passable beside it.
constexpr double besideCells = 0.3;

// The times at four middles, [z][x], for those between them.
struct Around {
  double time[2][2];
  bool isBeside = false;  // some of them are passable and some are not
  double latest = 0;
};

Around timesAround(const WayField& way, const glm::dvec2& first) {
  const auto cellAt = [&](int x, int z) {
    return (static_cast<size_t>(first.y) + static_cast<size_t>(z)) * way.columns +
           static_cast<size_t>(first.x) + static_cast<size_t>(x);
  };
  const auto open = [&](int x, int z) -> std::optional<double> {
    if (!std::isfinite(way.cost[cellAt(x, z)])) return {};
    return way.times[cellAt(x, z)];
  };
  // The field of those who flee leads straight out.
  const bool leadsAlong = way.goal != glm::dvec2(wayOut);
  Around around;
  for (const int z : {0, 1})
    for (const int x : {0, 1}) {
      double& time = around.time[z][x] = way.times[cellAt(x, z)];
      const std::optional<double> besideX = open(1 - x, z), besideZ = open(x, 1 - z),
                                  across = open(1 - x, 1 - z);
      if (leadsAlong && !open(x, z) && (besideX || besideZ || across)) {
        around.isBeside = true;
        if (besideX && besideZ) {
          time = std::max(*besideX, *besideZ);
          if (across) time = std::max(time, *besideX + (*besideZ - *across));
        } else {
          time = besideX ? *besideX : besideZ ? *besideZ : *across + besideCells * way.cell;
        }
        time += besideCells * way.cell;
      }
      around.latest = std::max(around.latest, time);
    }
  return around;
}

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
  const Around times = timesAround(way, around);
  const double t00 = times.time[0][0], t10 = times.time[0][1], t01 = times.time[1][0], t11 = times.time[1][1];
  const double time = (1 - f.y) * ((1 - f.x) * t00 + f.x * t10) + f.y * ((1 - f.x) * t01 + f.x * t11);
  const glm::dvec2 gradient((1 - f.y) * (t10 - t00) + f.y * (t11 - t01),
                            (1 - f.x) * (t01 - t00) + f.x * (t11 - t10));
  const double steepness = std::max(glm::length(gradient), 1e-6);
  result.rise =
      std::max({std::abs(t10 - t00), std::abs(t11 - t01), std::abs(t01 - t00), std::abs(t11 - t10)});
  result.turning = std::abs(t11 - t01 - t10 + t00) / steepness;
  // Sums of times are rounded as these are, and not as their differences.
  result.magnified = (result.rise + (times.isBeside ? times.latest : 0)) / steepness;
  result.stopMargin = std::abs(time - arrivalRadius);
  result.passMargin = std::abs(time - passedRadii * arrivalRadius);
  result.passes = taken(time < passedRadii * arrivalRadius, choices.passes);
  if (!taken(time < arrivalRadius, choices.stops))
    result.desired = -speed * std::min(1.0, time / tuning.slowRadius) * gradient / steepness;
  return result;
}

}  // namespace skitter::reference

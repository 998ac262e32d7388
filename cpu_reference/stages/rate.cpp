#include "cpu_reference/stages/rate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace skitter::reference {
namespace {

constexpr double farthestAside = 32767;  // quarter metres, on an axis
constexpr double nearestSquare = 8;
constexpr double longestTick = 2.0 / 15 + 1e-7;  // seconds

}  // namespace

double rateSquare(const RatedBlock& block, const glm::dvec3& camera) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const glm::dvec3& place : block.places) {
    const glm::dvec3 apart = glm::abs(glm::floor(4.0 * place) - glm::floor(4.0 * camera));
    const glm::dvec3 cut = glm::min(apart, glm::dvec3(farthestAside));
    nearest = std::min(nearest, glm::dot(cut, cut));
  }
  return std::max(nearest, nearestSquare);
}

RateBounds<double> rateEdges(const RateTuning& tuning, std::span<const SeenBlock> seen) {
  RateBounds<double> edges{};
  uint64_t room = 0;
  for (size_t k = 0; k < edges.size(); ++k) {
    room += tuning.most[k];
    for (int step = 0; step < 29 * 8; ++step) {
      const double beyond = std::ldexp(9.0 + step % 8, step / 8);  // the first square that is too far
      uint64_t within = 0;
      for (const SeenBlock& block : seen) within += block.square < beyond ? block.agents : 0;
      if (within > room) break;
      edges[k] = beyond - 1;
    }
  }
  return edges;
}

RateResult rate(const RateTuning& tuning, const RatedBlock& block, uint64_t tick,
                const std::optional<double>& square, const RateBounds<double>& edges) {
  const uint64_t turn = tick + block.number;
  const auto divides = [&](int level) { return turn % (uint64_t{1} << level) == 0; };
  RateResult result{.hasTurn = divides(block.level), .level = block.level};
  if (!result.hasTurn) return result;
  int wanted = 0;
  if (square) {
    wanted = block.level;
    for (int k = 0; k < rateLevels - 1; ++k) {
      const auto level = static_cast<size_t>(k);
      const double reach =
          std::min(std::floor(16 * tuning.distances[level] * tuning.distances[level]), edges[level]);
      // Beyond its reach no level stays, and within four fifths of it nobody stays slower.
      if (*square > reach) wanted = std::max(wanted, k + 1);
    }
    for (int k = rateLevels - 2; k >= 0; --k) {
      const auto level = static_cast<size_t>(k);
      const double reach =
          std::min(std::floor(16 * tuning.distances[level] * tuning.distances[level]), edges[level]);
      if (*square <= reach - std::floor(reach / 5)) wanted = std::min(wanted, k);
    }
  }
  if (!block.calm) wanted = 0;
  while (wanted > 0 && tuning.dt * (1 << wanted) > longestTick) --wanted;
  while (!divides(wanted)) --wanted;
  result.level = wanted;
  return result;
}

Tuning overTicks(const Tuning& tuning, int ticks) {
  Tuning over = tuning;
  over.ticks = ticks;
  over.dt = tuning.dt * ticks;
  over.heightBlend = 1 - std::pow(1 - tuning.heightBlend, ticks);
  over.tiltBlend = 1 - std::pow(1 - tuning.tiltBlend, ticks);
  over.clipFade = tuning.clipFade * ticks;
  over.plantKeep = std::pow(tuning.plantKeep, ticks);
  return over;
}

IkPlan overTicks(const IkPlan& plan, int ticks) {
  IkPlan over = plan;
  if (ticks > 2) over.rounds = 2;
  return over;
}

}  // namespace skitter::reference

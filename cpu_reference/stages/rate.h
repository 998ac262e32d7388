#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "cpu_reference/stages/ik.h"
#include "cpu_reference/types.h"

// Levels of rate (docs/levels.md).
namespace skitter::reference {

inline constexpr int rateLevels = 4;

// One value for each level but the last one.
template <typename Value>
using RateBounds = std::array<Value, rateLevels - 1>;

struct RateTuning {
  RateBounds<double> distances{};  // metres
  RateBounds<uint64_t> most{};     // agents
  double dt = 0;                   // of the crowd, seconds
};

// A block as a tick finds it.
struct RatedBlock {
  uint64_t number = 0;
  int level = 0;
  std::vector<glm::dvec3> places = {};  // of its agents that are there, world metres
  bool calm = true;                     // no push and nothing else disturbs one of these
};

// A tick counts a block so.
struct SeenBlock {
  double square = 0;  // of its distance, quarter metres
  size_t agents = 0;
};
// Infinite where nobody is there.
double rateSquare(const RatedBlock& block, const glm::dvec3& camera);
// The square to which each level has room, by what the tick before the last one counted.
RateBounds<double> rateEdges(const RateTuning& tuning, std::span<const SeenBlock> seen);

struct RateResult {
  bool hasTurn = false;
  int level = 0;  // at which it goes on
};
// `square` is none without a camera.
RateResult rate(const RateTuning& tuning, const RatedBlock& block, uint64_t tick,
                const std::optional<double>& square, const RateBounds<double>& edges);

// The tuning of an agent that ticks in every so many-th tick, and how it solves its legs.
Tuning overTicks(const Tuning& tuning, int ticks);
IkPlan overTicks(const IkPlan& plan, int ticks);

}  // namespace skitter::reference

#include "validation/convert_forage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "shared/forage.h"
#include "skitter/error.h"
#include "skitter/records.h"
#include "validation/vec4s.h"

namespace skitter::validation {
namespace {

constexpr double quantaInMetre = 1024;

uint32_t inGrains(float units) { return static_cast<uint32_t>(std::lround(256 * double{units})); }

// 2^32 times a share, as much as a word holds.
uint64_t in32Bits(double share) {
  return static_cast<uint64_t>(std::min(std::floor(share * 0x1p32), 0x1p32 - 1));
}

int64_t cellAlong(double place, double origin, double cell, int64_t count) {
  return std::clamp<int64_t>(static_cast<int64_t>(std::floor((place - origin) / cell)), 0, count - 1);
}

glm::dvec4 forageRecord(const HerdState& state, size_t agent, size_t part) {
  return load(state.forager, agent * shared::FORAGER_STRIDE + part);
}

}  // namespace

reference::ForageMap forageMapOf(const Forage& forage, const CostGrid& grid) {
  reference::ForageMap map;
  map.columns = grid.columns;
  map.rows = grid.rows;
  map.cell = std::llround(double{grid.cell} * quantaInMetre);
  map.originX = std::llround(double{grid.origin.x} * quantaInMetre);
  map.originZ = std::llround(double{grid.origin.y} * quantaInMetre);
  const double cell = double{grid.cell};
  const auto cellOf = [&](const glm::vec2& place) {
    return cellAlong(double{place.y}, double{grid.origin.y}, cell, map.rows) * map.columns +
           cellAlong(double{place.x}, double{grid.origin.x}, cell, map.columns);
  };
  for (int64_t at = 0; at < map.columns * map.rows; ++at) {
    const glm::dvec2 middle(double{grid.origin.x} + cell * (static_cast<double>(at % map.columns) + 0.5),
                            double{grid.origin.y} + cell * (static_cast<double>(at / map.columns) + 0.5));
    const auto isIn = [&](const glm::vec2& centre, float radius) {
      return glm::distance(middle, glm::dvec2(centre)) <= double{radius} || cellOf(centre) == at;
    };
    const bool nest = isIn(forage.nest.centre, forage.nest.radius);
    int64_t source = -1, branch = -1;
    for (size_t s = forage.food.size(); s-- > 0 && !nest;)
      if (isIn(forage.food[s].centre, forage.food[s].radius)) source = static_cast<int64_t>(s);
    for (size_t b = forage.branches.size(); b-- > 0 && !nest && source < 0;)
      if (isIn(forage.branches[b].centre, forage.branches[b].radius)) branch = static_cast<int64_t>(b);
    map.passable.push_back(std::isfinite(grid.cost[static_cast<size_t>(at)]));
    map.nest.push_back(nest);
    map.source.push_back(source);
    map.branch.push_back(branch);
  }
  for (const FoodSource& source : forage.food) map.amounts.push_back(source.amount);
  const int64_t nest = cellOf(forage.nest.centre);
  map.nestColumn = nest % map.columns;
  map.nestRow = nest / map.columns;
  map.branches = forage.branches.size();
  return map;
}

reference::ForageTuning forageTuningOf(const Forage& forage, uint64_t seed, double dt) {
  reference::ForageTuning tuning;
  tuning.seed = seed;
  tuning.leave = forage.rest > 0 ? in32Bits(dt / double{forage.rest}) : uint64_t{0xffffffff};
  tuning.threshold = inGrains(forage.threshold);
  tuning.power = forage.power;
  tuning.layHome = inGrains(forage.layHome);
  tuning.layOut = inGrains(forage.layOut);
  tuning.patience = forage.patience;
  if (dt > 0) tuning.every = static_cast<uint64_t>(std::max(1.0, std::round(1 / dt)));
  tuning.evaporation = in32Bits(1 - std::exp(-static_cast<double>(tuning.every) * dt / double{forage.life}));
  return tuning;
}

reference::Forager foragerOf(const HerdState& state, size_t agent) {
  const glm::dvec4 aim = forageRecord(state, agent, 0), last = forageRecord(state, agent, 1);
  const auto packed = static_cast<int64_t>(aim.w);
  const int64_t place = packed / shared::FORAGE_STATES;
  reference::Forager forager;
  forager.cell = static_cast<int64_t>(aim.x) - 1;
  forager.headingX = static_cast<int64_t>(aim.y);
  forager.headingZ = static_cast<int64_t>(aim.z);
  forager.state = static_cast<reference::Foraging>(packed % shared::FORAGE_STATES);
  forager.steps = static_cast<int64_t>(last.w);
  forager.lastBranch = place >= shared::PLACE_BRANCH ? place - shared::PLACE_BRANCH : -1;
  return forager;
}

reference::ForageDeed deedOf(const HerdState& state, size_t agent) {
  using Kind = reference::ForageDeed::Kind;
  const glm::dvec4 record = forageRecord(state, agent, 1);
  reference::ForageDeed deed;
  deed.entered = static_cast<int64_t>(record.x) - 1;
  deed.grains = static_cast<uint32_t>(record.y);
  const auto kind = static_cast<int64_t>(record.z);
  if (kind == shared::DEED_EMPTY) deed.kind = Kind::empty;
  if (kind == shared::DEED_BROUGHT) deed.kind = Kind::brought;
  if (const int64_t source = kind - shared::DEED_AT - shared::PLACE_FOOD; source >= 0) {
    const bool isBranch = source >= shared::MOST_SOURCES;
    deed.kind = isBranch ? Kind::passed : Kind::took;
    deed.of = isBranch ? source - shared::MOST_SOURCES : source;
  }
  return deed;
}

reference::ForageTrail trailOf(const HerdState& state, const reference::ForageMap& map) {
  using namespace shared;
  const auto cells = static_cast<size_t>(map.columns * map.rows);
  if (state.trail.size() != TRAIL_CELLS + cells)
    throw inputError(
        fmt::format("trail: found {} words, expected {}", state.trail.size(), TRAIL_CELLS + cells));
  reference::ForageTrail trail;
  trail.empty = state.trail[DEED_EMPTY];
  trail.brought = state.trail[DEED_BROUGHT];
  for (size_t s = 0; s < map.amounts.size(); ++s)
    trail.taken.push_back(state.trail[PLACE_FOOD + DEED_AT + s]);
  for (size_t b = 0; b < map.branches; ++b) trail.passed.push_back(state.trail[PLACE_BRANCH + DEED_AT + b]);
  trail.grains.assign(state.trail.begin() + TRAIL_CELLS, state.trail.end());
  return trail;
}

}  // namespace skitter::validation

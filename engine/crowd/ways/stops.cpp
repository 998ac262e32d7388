#include "crowd/ways/stops.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shared/ways.h"

namespace skitter::crowd {
namespace {

// Calls each(cell) with the neighbours over the four sides.
template <class Each>
void eachBeside(const CostGrid& grid, size_t cell, const Each& each) {
  const size_t column = cell % grid.columns, row = cell / grid.columns;
  if (column > 0) each(cell - 1);
  if (column + 1 < grid.columns) each(cell + 1);
  if (row > 0) each(cell - grid.columns);
  if (row + 1 < grid.rows) each(cell + grid.columns);
}

uint32_t along(double place, double origin, double cell, uint32_t count) {
  return static_cast<uint32_t>(
      std::clamp(std::floor((place - origin) / cell), 0.0, static_cast<double>(count - 1)));
}

}  // namespace

Regions regionsOf(const CostGrid& grid) {
  Regions regions{.of = std::vector<uint32_t>(grid.cost.size(), Regions::none)};
  std::vector<size_t> open;
  for (size_t first = 0; first < grid.cost.size(); ++first) {
    const auto enter = [&](size_t cell) {
      if (regions.of[cell] != Regions::none || !std::isfinite(grid.cost[cell])) return;
      regions.of[cell] = regions.count;
      open.push_back(cell);
    };
    enter(first);
    if (open.empty()) continue;
    while (!open.empty()) {
      const size_t cell = open.back();
      open.pop_back();
      eachBeside(grid, cell, enter);
    }
    ++regions.count;
  }
  return regions;
}

size_t cellAt(const CostGrid& grid, const glm::vec2& place) {
  const double cell = double{grid.cell};
  const uint32_t column = along(double{place.x}, double{grid.origin.x}, cell, grid.columns);
  return size_t{along(double{place.y}, double{grid.origin.y}, cell, grid.rows)} * grid.columns + column;
}

glm::dvec2 middleOf(const CostGrid& grid, size_t cell) {
  return glm::dvec2(grid.origin) +
         double{grid.cell} * (glm::dvec2(cell % grid.columns, cell / grid.columns) + 0.5);
}

Stops stopsOf(const CostGrid& grid, const Regions& regions, const glm::vec2& goal) {
  if (goal == glm::vec2(shared::WAY_OUT)) {
    Stops out{.stop = goal};
    for (size_t cell = 0; cell < grid.cost.size(); ++cell)
      if (regions.of[cell] != Regions::none) out.cells.push_back({cell, 0});
    return out;
  }
  if (regions.count == 0) return {.stop = goal};
  const glm::dvec2 target(goal);
  Stops stops{.stop = goal, .region = regions.of[cellAt(grid, goal)]};
  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();
    size_t cell = 0;
  };
  std::vector<Nearest> nearest(regions.count);
  for (size_t cell = 0; cell < grid.cost.size(); ++cell) {
    const uint32_t region = regions.of[cell];
    if (region == Regions::none) continue;
    const glm::dvec2 away = glm::abs(middleOf(grid, cell) - target);
    const double distance = glm::length(away);
    if (distance < nearest[region].distance) nearest[region] = {distance, cell};
    // The four middles around the goal; rounding may add those beside them, whose times are as true.
    if (region == stops.region && std::max(away.x, away.y) < double{grid.cell})
      stops.cells.push_back({cell, static_cast<float>(double{grid.cost[cell]} * distance)});
  }
  for (uint32_t region = 0; region < regions.count; ++region)
    if (region != stops.region) stops.cells.push_back({nearest[region].cell, 0});
  if (stops.region == Regions::none)
    stops.stop = middleOf(grid, std::ranges::min(nearest, {}, &Nearest::distance).cell);
  return stops;
}

}  // namespace skitter::crowd

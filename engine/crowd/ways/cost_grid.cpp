#include "crowd/ways/cost_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "assets/scenes/obstacles.h"
#include "crowd/ways/shapes.h"
#include "crowd/ways/stops.h"
#include "skitter/error.h"
#include "skitter/ways.h"

namespace skitter {
namespace {

constexpr float impassable = std::numeric_limits<float>::infinity();

void checkTraveller(const Traveller& traveller) {
  const auto expect = [](const char* key, float value) {
    if (!(std::isfinite(value) && value >= 0))
      throw inputError(fmt::format("traveller.{} is {}, expected a finite number from 0 on", key, value));
  };
  expect("legLength", traveller.legLength);
  expect("footprint", traveller.footprint);
  expect("margin", traveller.margin);
  expect("ways.climb", traveller.ways.climb);
  expect("ways.steepest", traveller.ways.steepest);
  expect("ways.step", traveller.ways.step);
}

void checkCostGrid(const CostGrid& grid) {
  if (grid.columns < 2 || grid.rows < 2 || grid.cost.size() != size_t{grid.columns} * grid.rows)
    throw inputError(
        fmt::format("a grid of {} x {} cells has {} costs, expected 2 a side or more and a cost "
                    "for each cell",
                    grid.columns, grid.rows, grid.cost.size()));
  if (!(std::isfinite(grid.cell) && grid.cell > 0))
    throw inputError(fmt::format("a cell of a grid is {} m, expected more than 0", grid.cell));
  for (int i = 0; i < 2; ++i)
    if (!std::isfinite(grid.origin[i]))
      throw inputError(
          fmt::format("origin[{}] of a grid is {}, expected a finite number", i, grid.origin[i]));
}

CostGrid emptyGrid(const Heightfield& terrain, const Traveller& traveller) {
  const double sideX = double{terrain.extentX()}, sideZ = double{terrain.extentZ()};
  const double usual = traveller.cell > 0 ? double{traveller.cell} : 0.5 * double{traveller.legLength};
  const double cell = std::max(usual, std::max(sideX, sideZ) / crowd::mostCellsASide);
  const auto count = [&](double side) {
    return std::max(2u, static_cast<uint32_t>(std::ceil(side / cell * (1 - 1e-6))));
  };
  CostGrid grid{.columns = count(sideX),
                .rows = count(sideZ),
                .cell = static_cast<float>(cell),
                .origin = {terrain.originX(), terrain.originZ()}};
  grid.cost.resize(size_t{grid.columns} * grid.rows);
  return grid;
}

// The nine heights around the middle of a cell, row after row.
using Nine = std::array<double, 9>;
Nine heightsAround(const Heightfield& terrain, const glm::dvec2& middle, double cell) {
  Nine heights;
  for (size_t k = 0; k < heights.size(); ++k) {
    const double x = middle.x + 0.5 * cell * (static_cast<double>(k % 3) - 1);
    const double z = middle.y + 0.5 * cell * (static_cast<double>(k / 3) - 1);
    heights[k] = double{terrain.at(static_cast<float>(x), static_cast<float>(z))};
  }
  return heights;
}

float costOfGround(const Nine& h, double cell, const Traveller& traveller) {
  const double riseX = 0.5 * (h[5] - h[3]), riseZ = 0.5 * (h[7] - h[1]);  // half a cell's
  double ledge = 0;
  for (size_t k = 0; k < h.size(); ++k) {
    if (k % 3 < 2) ledge = std::max(ledge, std::abs(h[k + 1] - h[k] - riseX));
    if (k / 3 < 2) ledge = std::max(ledge, std::abs(h[k + 3] - h[k] - riseZ));
  }
  const Ways& ways = traveller.ways;
  const double slope = std::hypot(riseX, riseZ) / (0.5 * cell);
  if (slope > double{ways.steepest} || ledge > double{ways.step} * double{traveller.legLength})
    return impassable;
  return static_cast<float>(1 + double{ways.climb} * slope);
}

// The first of `count` cells whose middle may be at `place` or beyond.
uint32_t cellFrom(double place, double origin, double cell, uint32_t count) {
  return static_cast<uint32_t>(
      std::clamp(std::floor((place - origin) / cell - 0.5), 0.0, static_cast<double>(count)));
}

// Half of a cell's diagonal or more, so that no line has a hole.
double grownBy(const CostGrid& grid, const Traveller& traveller) {
  return std::max(double{traveller.footprint}, double{grid.cell} / std::sqrt(2.0));
}

void blockAround(CostGrid& grid, const Obstacle& obstacle, double grown, const crowd::CellRange& within) {
  const auto [least, most] = crowd::boundsOf(obstacle);
  const double cell = double{grid.cell};
  const glm::dvec2 origin(grid.origin);
  const uint32_t column = cellFrom(least.x - grown, origin.x, cell, within.endColumn);
  const uint32_t endColumn = cellFrom(most.x + grown + 2 * cell, origin.x, cell, within.endColumn);
  const uint32_t row = cellFrom(least.y - grown, origin.y, cell, within.endRow);
  const uint32_t endRow = cellFrom(most.y + grown + 2 * cell, origin.y, cell, within.endRow);
  for (uint32_t z = std::max(row, within.row); z < endRow; ++z)
    for (uint32_t x = std::max(column, within.column); x < endColumn; ++x) {
      const size_t index = size_t{z} * grid.columns + x;
      if (crowd::distanceTo(obstacle, crowd::middleOf(grid, index)) < grown) grid.cost[index] = impassable;
    }
}

crowd::CellRange allOf(const CostGrid& grid) { return {0, 0, grid.columns, grid.rows}; }

}  // namespace

CostGrid costGrid(const Heightfield& terrain, std::span<const Obstacle> obstacles,
                  const Traveller& traveller) {
  terrain.check();
  checkTraveller(traveller);
  for (size_t i = 0; i < obstacles.size(); ++i)
    scenes::checkObstacle(obstacles[i], fmt::format("obstacles[{}]", i));
  CostGrid grid = emptyGrid(terrain, traveller);
  crowd::renewCosts(grid, terrain, obstacles, traveller, allOf(grid));
  return grid;
}

// A way cuts corners by less than a cell.
void keepOff(CostGrid& grid, std::span<const Threat> threats, const Traveller& traveller) {
  checkCostGrid(grid);
  checkTraveller(traveller);
  for (size_t i = 0; i < threats.size(); ++i) scenes::checkThreat(threats[i], fmt::format("threats[{}]", i));
  for (const auto& [centre, radius] : threats)
    if (radius > 0)
      blockAround(grid, {Disc{centre, radius}}, grownBy(grid, traveller) + double{grid.cell}, allOf(grid));
}

namespace crowd {

// A height between samples follows from those on either side.
CellRange cellsOver(const CostGrid& grid, const Heightfield& terrain, const HeightEdits::Rectangle& samples) {
  const double cell = double{grid.cell};
  // A cell beyond what follows from the heights half a cell around its middle, for rounding.
  const auto first = [&](uint32_t sample, float spacing, uint32_t count) {
    const double from = (static_cast<double>(sample) - 1) * double{spacing};
    return static_cast<uint32_t>(std::clamp(std::floor(from / cell) - 2, 0.0, static_cast<double>(count)));
  };
  const auto end = [&](uint32_t sample, float spacing, uint32_t count) {
    const double to = static_cast<double>(sample) * double{spacing};
    return static_cast<uint32_t>(std::clamp(std::ceil(to / cell) + 2, 0.0, static_cast<double>(count)));
  };
  return {.column = first(samples.x, terrain.spacingX, grid.columns),
          .row = first(samples.z, terrain.spacingZ, grid.rows),
          .endColumn = end(samples.x + samples.columns, terrain.spacingX, grid.columns),
          .endRow = end(samples.z + samples.rows, terrain.spacingZ, grid.rows)};
}

void renewCosts(CostGrid& grid, const Heightfield& terrain, std::span<const Obstacle> obstacles,
                const Traveller& traveller, const CellRange& cells) {
  const double cell = double{grid.cell};
  const glm::dvec2 inner = 0.5 * glm::dvec2(terrain.extentX(), terrain.extentZ()) - double{traveller.margin};
  for (uint32_t row = cells.row; row < cells.endRow; ++row)
    for (uint32_t column = cells.column; column < cells.endColumn; ++column) {
      const size_t index = size_t{row} * grid.columns + column;
      const glm::dvec2 middle = middleOf(grid, index);
      const bool inside = std::abs(middle.x) <= inner.x && std::abs(middle.y) <= inner.y;
      grid.cost[index] =
          inside ? costOfGround(heightsAround(terrain, middle, cell), cell, traveller) : impassable;
    }
  for (const Obstacle& obstacle : obstacles) blockAround(grid, obstacle, grownBy(grid, traveller), cells);
}

}  // namespace crowd

}  // namespace skitter

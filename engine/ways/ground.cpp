#include "ways/ground.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "shared/colony.h"
#include "skitter/colony.h"
#include "skitter/error.h"

namespace skitter::ways {
namespace {

constexpr std::array<glm::ivec2, directionCount> steps = {
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

size_t indexOf(const CostGrid& grid, glm::ivec2 at) {
  return static_cast<size_t>(at.y) * grid.columns + static_cast<size_t>(at.x);
}

uint32_t fixedCost(float cost) {
  return std::isfinite(cost) ? static_cast<uint32_t>(std::lround(256.0 * static_cast<double>(cost))) : 0;
}

}  // namespace

glm::ivec2 stepOf(uint32_t direction) { return steps[direction]; }

bool isPassable(const CostGrid& grid, glm::ivec2 at) {
  return at.x >= 0 && at.y >= 0 && at.x < static_cast<int>(grid.columns) &&
         at.y < static_cast<int>(grid.rows) && std::isfinite(grid.cost[indexOf(grid, at)]);
}

bool isOpen(const CostGrid& grid, glm::ivec2 at, uint32_t direction) {
  const glm::ivec2 step = stepOf(direction);
  return isPassable(grid, at) && isPassable(grid, at + step) && isPassable(grid, {at.x + step.x, at.y}) &&
         isPassable(grid, {at.x, at.y + step.y});
}

glm::uvec2 beside(glm::uvec2 cell, uint32_t direction) {
  return glm::uvec2(glm::ivec2(cell) + stepOf(direction));
}

void checkCell(const CostGrid& grid, const char* what, glm::uvec2 cell) {
  if (cell.x >= grid.columns || cell.y >= grid.rows)
    throw inputError(fmt::format("the {} of a colony is cell ({}, {}), expected one of {} x {}", what, cell.x,
                                 cell.y, grid.columns, grid.rows));
}

void checkCost(glm::uvec2 cell, float cost) {
  if (!(cost >= 1 && (cost <= Colony::maxCost || std::isinf(cost))))
    throw inputError(fmt::format("cell ({}, {}) of a colony's grid costs {}, expected 1 to {} or infinity",
                                 cell.x, cell.y, cost, Colony::maxCost));
}

void checkGrid(const CostGrid& grid) {
  for (const uint32_t side : {grid.columns, grid.rows})
    if (side < 1 || side > Colony::maxSide)
      throw inputError(fmt::format("a colony's grid is {} x {} cells, expected 1 to {} a side", grid.columns,
                                   grid.rows, Colony::maxSide));
  if (grid.cost.size() != size_t{grid.columns} * grid.rows)
    throw inputError(fmt::format("a colony's grid of {} x {} cells has {} costs", grid.columns, grid.rows,
                                 grid.cost.size()));
  if (!(std::isfinite(grid.cell) && grid.cell > 0))
    throw inputError(fmt::format("a cell of a colony's grid is {} m, expected more than 0", grid.cell));
  for (uint32_t row = 0; row < grid.rows; ++row)
    for (uint32_t column = 0; column < grid.columns; ++column)
      checkCost({column, row}, grid.cost[size_t{row} * grid.columns + column]);
}

std::vector<uint32_t> groundOf(const CostGrid& grid) {
  std::vector<uint32_t> ground(grid.cost.size());
  for (size_t index = 0; index < ground.size(); ++index) {
    const glm::ivec2 at(index % grid.columns, index / grid.columns);
    uint32_t word = fixedCost(grid.cost[index]) << shared::GROUND_COST_SHIFT;
    for (uint32_t direction = 0; direction < directionCount; ++direction)
      if (isOpen(grid, at, direction)) word |= 1u << direction;
    ground[index] = word;
  }
  return ground;
}

uint32_t lengthAlong(const CostGrid& grid, const std::vector<uint32_t>& ground, glm::uvec2 from,
                     const std::vector<uint32_t>& directions) {
  using namespace shared;
  const auto costAt = [&](glm::uvec2 at) {
    return uint64_t{(ground[indexOf(grid, at)] >> GROUND_COST_SHIFT) & GROUND_COST};
  };
  uint64_t length = 0;
  for (const uint32_t direction : directions) {
    if (((ground[indexOf(grid, from)] >> direction) & 1) == 0) return NO_WAY;
    const glm::uvec2 to = beside(from, direction);
    const uint64_t both = costAt(from) + costAt(to);
    length += direction % 2 == 0 ? both : (181 * both + 64) >> 7;
    from = to;
  }
  return length <= LONGEST_TRIP ? static_cast<uint32_t>(length) : NO_WAY;
}

}  // namespace skitter::ways

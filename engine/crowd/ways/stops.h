#pragma once

#include <cstdint>
#include <vector>

#include "skitter/ways.h"

namespace skitter::crowd {

// The regions of a grid without its impassable cells: the number of each cell's, from 0 on.
struct Regions {
  static constexpr uint32_t none = UINT32_MAX;  // of an impassable cell

  std::vector<uint32_t> of;
  uint32_t count = 0;
};
Regions regionsOf(const CostGrid& grid);

// Where agents stop who have a goal (docs/ways.md).
struct Stops {
  struct Cell {
    size_t cell;
    float time;
  };
  std::vector<Cell> cells = {};     // where times are given
  glm::vec2 stop{0};                // the goal, or the nearest of the cells' middles
  uint32_t region = Regions::none;  // that the goal is in
};
// Without cells where none is passable. `goal` is finite; that of those who flee, shared::WAY_OUT, has all
// passable cells.
Stops stopsOf(const CostGrid& grid, const Regions& regions, const glm::vec2& goal);

// Cells along the longer side of a large terrain: a field of them is solved in a fraction of a second on a
// processor, and 16 of them fit the 128 MiB of a small binding.
inline constexpr double mostCellsASide = 512;

// The cell of a place, or the nearest one.
size_t cellAt(const CostGrid& grid, const glm::vec2& place);
// The middle of a cell, world x, z.
glm::dvec2 middleOf(const CostGrid& grid, size_t cell);

}  // namespace skitter::crowd

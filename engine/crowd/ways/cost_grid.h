#pragma once

#include <cstdint>
#include <span>

#include "crowd/edit.h"
#include "skitter/heightfield.h"
#include "skitter/ways.h"

namespace skitter::crowd {

// Cells of a grid, from one column and row on to before others.
struct CellRange {
  uint32_t column = 0, row = 0, endColumn = 0, endRow = 0;
};
// Those whose costs depend on a rectangle of the terrain's samples.
CellRange cellsOver(const CostGrid& grid, const Heightfield& terrain, const HeightEdits::Rectangle& samples);

// Makes the costs of those cells what costGrid() makes of them.
void renewCosts(CostGrid& grid, const Heightfield& terrain, std::span<const Obstacle> obstacles,
                const Traveller& traveller, const CellRange& cells);

}  // namespace skitter::crowd

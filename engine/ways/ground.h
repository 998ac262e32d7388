#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "skitter/ways.h"

// A grid of costs as the colony's kernels read it: a word per cell (shaders/shared/colony.h).
namespace skitter::ways {

// Throws Error(input) naming what a colony cannot walk on.
void checkGrid(const CostGrid&);
void checkCost(glm::uvec2 cell, float cost);
void checkCell(const CostGrid&, const char* what, glm::uvec2 cell);

std::vector<uint32_t> groundOf(const CostGrid&);
// The length of the way along these directions, or NO_WAY (shared/colony.h): too long, or impassable.
uint32_t lengthAlong(const CostGrid&, const std::vector<uint32_t>& ground, glm::uvec2 from,
                     const std::vector<uint32_t>& directions);
// Direction d is 0 for +x and turns by +z (docs/colony.md).
inline constexpr uint32_t directionCount = 8;
glm::ivec2 stepOf(uint32_t direction);
// False beyond the grid, too.
bool isPassable(const CostGrid&, glm::ivec2 at);
// A diagonal move needs both cells beside it, so that nobody cuts a corner.
bool isOpen(const CostGrid&, glm::ivec2 at, uint32_t direction);
// Column and row beside a cell of the grid, in one of the eight directions.
glm::uvec2 beside(glm::uvec2 cell, uint32_t direction);

}  // namespace skitter::ways

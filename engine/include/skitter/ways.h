#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace skitter {

// Square cells over a terrain, row after row along +z.
struct CostGrid {
  uint32_t columns = 0, rows = 0;
  float cell = 0;       // metres a side
  glm::vec2 origin{0};  // x, z of the corner of cell (0, 0)
  // cost[row * columns + column] is the time that a metre through the cell takes, over that of flat ground:
  // at least 1, infinite where it is impassable.
  std::vector<float> cost;
};

}  // namespace skitter

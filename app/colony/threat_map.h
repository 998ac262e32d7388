#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "skitter/ways.h"

namespace skitter::app {

// A square map for scouts (docs/colony.md): twelve threats, hills of cost up to 10 that may add up, and ten
// walls, from the middle of its left side to the middle of its right side. The same bits for the same
// arguments on every machine.
struct ThreatMap {
  CostGrid grid;  // cells of 1 m
  glm::uvec2 nest{0}, goal{0};
};
ThreatMap threatMap(uint32_t side, uint64_t number);

}  // namespace skitter::app

#pragma once

#include <cstdint>
#include <string>

#include "cpu_reference/ways/colony.h"
#include "skitter/colony.h"

namespace skitter::test {

// Text becomes a grid, a row a line: '#' impassable, '1' to '9' costs, 'n' and 'g' the nest and the goal, of
// cost 1.
struct ColonyCase {
  std::string name;
  CostGrid grid;
  glm::uvec2 nest{0}, goal{0};
  Colony::Options options = {};
};
ColonyCase drawnCase(const std::string& name, const std::string& picture);

// app::threatMap.
ColonyCase threatCase(uint32_t side, uint64_t seed);

reference::Colony referenceOf(const ColonyCase&);
uint32_t indexOf(const ColonyCase&, glm::uvec2 cell);

// Empty, or in what device and reference first differ after these iterations, compared one by one.
std::string differenceOf(Colony&, reference::Colony&, const ColonyCase&, uint32_t iterations);
std::string differenceNow(const Colony&, const reference::Colony&, const ColonyCase&);

}  // namespace skitter::test

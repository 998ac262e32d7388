#pragma once

#include <cstdint>
#include <vector>

namespace skitter {

// Gives every NaN of a row-major grid a height and returns how many there were; the grid is left alone where
// nothing else is in it. The result is near the solution of the discrete Laplace equation, in which each
// filled sample is the mean of its neighbours: smooth, meeting the known samples, and never outside their
// range.
uint64_t fillVoids(std::vector<float>& values, uint32_t columns, uint32_t rows);

}  // namespace skitter

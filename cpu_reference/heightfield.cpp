#include "cpu_reference/heightfield.h"

#include <algorithm>
#include <cmath>

namespace skitter::reference {
namespace {

struct Cell {
  int column, row;
  double a, b;                // fractions along x and z
  double h00, h10, h01, h11;  // h[j][i], h[j][i+1], h[j+1][i], h[j+1][i+1]
};

double sample(const Heights& heights, int column, int row) {
  return heights
      .samples[static_cast<size_t>(row) * static_cast<size_t>(heights.columns) + static_cast<size_t>(column)];
}

Cell cellAt(const Heights& heights, double x, double z) {
  // fmax and fmin drop a NaN, so that a position that is none still names a cell.
  const double u =
      std::fmin(std::fmax((x - heights.originX) * heights.inverseSpacingX, 0), heights.columns - 1.0);
  const double v =
      std::fmin(std::fmax((z - heights.originZ) * heights.inverseSpacingZ, 0), heights.rows - 1.0);
  const int i = std::min(static_cast<int>(std::floor(u)), heights.columns - 2);
  const int j = std::min(static_cast<int>(std::floor(v)), heights.rows - 2);
  return {i,
          j,
          u - i,
          v - j,
          sample(heights, i, j),
          sample(heights, i + 1, j),
          sample(heights, i, j + 1),
          sample(heights, i + 1, j + 1)};
}

}  // namespace

double heightAt(const Heights& heights, double x, double z) {
  const Cell c = cellAt(heights, x, z);
  return glm::mix(glm::mix(c.h00, c.h10, c.a), glm::mix(c.h01, c.h11, c.a), c.b);
}

glm::dvec3 normalAt(const Heights& heights, double x, double z) {
  const Cell c = cellAt(heights, x, z);
  const double gx = glm::mix(c.h10 - c.h00, c.h11 - c.h01, c.b) * heights.inverseSpacingX;
  const double gz = (glm::mix(c.h01, c.h11, c.a) - glm::mix(c.h00, c.h10, c.a)) * heights.inverseSpacingZ;
  return normalized(glm::dvec3(-gx, 1, -gz));
}

Relief reliefNear(const Heights& heights, double x, double z) {
  const Cell c = cellAt(heights, x, z);
  const int left = std::max(c.column - 1, 0), right = std::min(c.column + 2, heights.columns - 1);
  const int near = std::max(c.row - 1, 0), far = std::min(c.row + 2, heights.rows - 1);
  Relief relief;
  for (int j = near; j <= far; ++j) {
    for (int i = left; i <= right; ++i) {
      const double h = sample(heights, i, j);
      relief.height = std::max(relief.height, std::abs(h));
      if (i < right) {
        relief.slopeX =
            std::max(relief.slopeX, std::abs(sample(heights, i + 1, j) - h) * heights.inverseSpacingX);
      }
      if (j < far) {
        relief.slopeZ =
            std::max(relief.slopeZ, std::abs(sample(heights, i, j + 1) - h) * heights.inverseSpacingZ);
      }
    }
  }
  return relief;
}

}  // namespace skitter::reference

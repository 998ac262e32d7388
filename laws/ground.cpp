#include "laws/ground.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace skitter::laws {
namespace {

// Where a point lies among the samples of an axis.
struct Place {
  size_t first;
  double share;
};
Place placeOf(double value, double origin, double spacing, uint32_t samples) {
  const double scaled = std::clamp((value - origin) / spacing, 0.0, static_cast<double>(samples - 1));
  const auto first = std::min(static_cast<size_t>(scaled), static_cast<size_t>(samples) - 2);
  return {first, scaled - static_cast<double>(first)};
}

struct Cell {
  double nearLeft, nearRight, farLeft, farRight;  // heights
  double u, v;                                    // shares of the way to the right and to the far side
};
Cell cellOf(const Ground& ground, double x, double z) {
  const Place column = placeOf(x, ground.originX, ground.spacingX, ground.columns);
  const Place row = placeOf(z, ground.originZ, ground.spacingZ, ground.rows);
  const float* near = ground.heights.data() + row.first * ground.columns + column.first;
  const float* far = near + ground.columns;
  return {double{near[0]}, double{near[1]}, double{far[0]}, double{far[1]}, column.share, row.share};
}

}  // namespace

double Ground::at(double x, double z) const {
  const Cell c = cellOf(*this, x, z);
  return std::lerp(std::lerp(c.nearLeft, c.nearRight, c.u), std::lerp(c.farLeft, c.farRight, c.u), c.v);
}

glm::dvec3 Ground::normalAt(double x, double z) const {
  const Cell c = cellOf(*this, x, z);
  const double alongX = std::lerp(c.nearRight - c.nearLeft, c.farRight - c.farLeft, c.v) / spacingX;
  const double alongZ = std::lerp(c.farLeft - c.nearLeft, c.farRight - c.nearRight, c.u) / spacingZ;
  return glm::normalize(glm::dvec3(-alongX, 1, -alongZ));
}

double Ground::over(const glm::dvec3& point) const {
  return (point.y - at(point.x, point.z)) * normalAt(point.x, point.z).y;
}

bool Ground::holds(double x, double z, double radius) const {
  return x - radius >= originX && z - radius >= originZ && x + radius <= originX + spacingX * (columns - 1) &&
         z + radius <= originZ + spacingZ * (rows - 1);
}

// Two rings of eight and the middle. They are symmetrical, so each slope of the plane is a sum by itself.
Footing footingOf(const Ground& ground, double x, double z, double radius) {
  constexpr double diagonal = 0.70710678118654752;
  constexpr std::array<std::array<double, 2>, 8> ring = {{{1, 0},
                                                          {diagonal, diagonal},
                                                          {0, 1},
                                                          {-diagonal, diagonal},
                                                          {-1, 0},
                                                          {-diagonal, -diagonal},
                                                          {0, -1},
                                                          {diagonal, -diagonal}}};
  const double middle = ground.at(x, z);
  Footing footing{.lowest = middle, .highest = middle};
  double alongX = 0, alongZ = 0, squares = 0;
  for (const double part : {0.5, 1.0})
    for (const auto& [dx, dz] : ring) {
      const double offX = radius * part * dx, offZ = radius * part * dz;
      const double height = ground.at(x + offX, z + offZ);
      footing.lowest = std::min(footing.lowest, height);
      footing.highest = std::max(footing.highest, height);
      alongX += height * offX;
      alongZ += height * offZ;
      squares += offX * offX;
    }
  footing.normal = glm::normalize(glm::dvec3(-alongX / squares, 1, -alongZ / squares));
  return footing;
}

}  // namespace skitter::laws

#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace skitter::laws {

// Heights at the corners of a grid, bilinear in between, row after row along z. Beyond the edge they stay.
struct Ground {
  double originX = 0, originZ = 0, spacingX = 1, spacingZ = 1;  // metres
  uint32_t columns = 2, rows = 2;
  std::span<const float> heights;

  double at(double x, double z) const;
  glm::dvec3 normalAt(double x, double z) const;  // unit
  // How far a point is over the ground, square to it; below 0 in it.
  double over(const glm::dvec3& point) const;
  // Whether a disc lies on the grid.
  bool holds(double x, double z, double radius) const;
};

// The ground below a disc.
struct Footing {
  double lowest = 0, highest = 0;
  glm::dvec3 normal{0, 1, 0};  // of the plane that fits it best
};
Footing footingOf(const Ground& ground, double x, double z, double radius);

}  // namespace skitter::laws

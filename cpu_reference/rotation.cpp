#include "cpu_reference/rotation.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace skitter::reference {

glm::dmat3 shortestFromZ(const glm::dvec3& d) {
  const double k = 1 / std::max(1 + d.z, 1e-12);
  return {glm::dvec3(1 - k * d.x * d.x, -k * d.x * d.y, -d.x),
          glm::dvec3(-k * d.x * d.y, 1 - k * d.y * d.y, -d.y), d};
}

glm::dmat3 shortest(const glm::dvec3& a, const glm::dvec3& b) {
  const double cosine = glm::dot(a, b);
  if (cosine < -0.999999) {
    const glm::dvec3 across = std::abs(a.y) > 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 axis = glm::normalize(glm::cross(across, a));
    return 2.0 * glm::outerProduct(axis, axis) - glm::dmat3(1);
  }
  const glm::dvec3 v = glm::cross(a, b);
  const glm::dmat3 cross{glm::dvec3(0, v.z, -v.y), glm::dvec3(-v.z, 0, v.x), glm::dvec3(v.y, -v.x, 0)};
  return glm::dmat3(1) + cross + cross * cross / (1 + cosine);
}

glm::dmat3 turnBy(const glm::dvec3& omega) {
  return glm::mat3_cast(glm::normalize(glm::dquat(1, omega.x / 2, omega.y / 2, omega.z / 2)));
}

glm::dvec3 perpendicular(const glm::dvec3& wish, const glm::dvec3& line) {
  const glm::dvec3 rest = wish - line * glm::dot(wish, line);
  if (glm::length(rest) >= 1e-6) return glm::normalize(rest);
  const glm::dvec3 other = std::abs(line.x) > 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  return glm::normalize(other - line * glm::dot(other, line));
}

}  // namespace skitter::reference

#include "cpu_reference/ik/two_bone.h"

#include <algorithm>

#include "cpu_reference/rotation.h"

namespace skitter::reference {
namespace {

glm::dvec3 lineTo(const glm::dvec3& target, const Joints& joints) {
  for (const glm::dvec3& point : {target, joints[2]}) {
    if (glm::length(point) >= 1e-6) return glm::normalize(point);
  }
  return normalized(joints[1]);
}

}  // namespace

void twoBone(const IkChain& chain, const glm::dvec3& target, Joints& joints) {
  const double l0 = chain.bones[0].length, l1 = chain.bones[1].length;
  const double distance = std::clamp(glm::length(target), std::abs(l0 - l1), l0 + l1);
  const glm::dvec3 line = lineTo(target, joints);
  const glm::dvec3 side = perpendicular(chain.pole.value_or(joints[1]), line);
  const double along = distance < 1e-6 ? 0 : (distance * distance + l0 * l0 - l1 * l1) / (2 * distance);
  joints[1] = along * line + std::sqrt(std::max(l0 * l0 - along * along, 0.0)) * side;
  joints[2] = joints[1] + l1 * normalized(distance * line - joints[1]);
}

}  // namespace skitter::reference

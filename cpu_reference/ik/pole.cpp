#include "cpu_reference/ik/pole.h"

#include "cpu_reference/rotation.h"

namespace skitter::reference {
namespace {

glm::dvec3 bendOf(const Joints& joints) {
  const glm::dvec3 line = normalized(joints.back());
  glm::dvec3 bend(0);
  for (const glm::dvec3& joint : joints) bend += joint - line * glm::dot(joint, line);
  return bend;
}

}  // namespace

double bendToward(const glm::dvec3& pole, const Joints& joints) { return glm::dot(bendOf(joints), pole); }

void turnToPole(const glm::dvec3& pole, Joints& joints) {
  const glm::dvec3 line = normalized(joints.back()), bend = bendOf(joints);
  const glm::dvec3 across = pole - line * glm::dot(pole, line);
  if (glm::length(joints.back()) < 1e-6 || glm::length(bend) < 1e-6 || glm::length(across) < 1e-6) return;
  // Half a turn must be about the line too.
  const glm::dvec3 from = glm::normalize(bend), to = glm::normalize(across), aside = glm::cross(line, from);
  const double cosine = glm::dot(from, to), sine = glm::dot(aside, to);
  for (glm::dvec3& joint : joints) {
    const glm::dvec3 along = line * glm::dot(joint, line), off = joint - along;
    joint = along + cosine * off + sine * glm::cross(line, off);
  }
}

}  // namespace skitter::reference

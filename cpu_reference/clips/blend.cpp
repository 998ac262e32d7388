#include "cpu_reference/clips/blend.h"

namespace skitter::reference {
namespace {

Affine between(const ClipTable& table, const Play::Played& played, size_t joint) {
  const Affine& matrix = table.matrix(played.frame, joint);
  if (played.fraction == 0) return matrix;
  return (1 - played.fraction) * matrix + played.fraction * table.matrix(played.frame + 1, joint);
}

}  // namespace

Affine blended(const ClipTable& table, const Play& play, size_t joint) {
  return (1 - play.weight) * between(table, play.from, joint) + play.weight * between(table, play.to, joint);
}

std::vector<glm::dvec3> blendedJoints(const ClipTable& table, const Play& play, size_t leg) {
  std::vector<glm::dvec3> joints;
  for (const ClipTable::LegJoint& joint : table.legs[leg]) {
    joints.push_back(blended(table, play, joint.joint) * glm::dvec4(joint.start, 1));
  }
  return joints;
}

bool standsInClip(const ClipTable& table, const Play& play, size_t leg) {
  const Play::Played& played = play.weight < 0.5 ? play.from : play.to;
  return (table.frames[played.frame].standing >> leg & 1u) != 0;
}

}  // namespace skitter::reference

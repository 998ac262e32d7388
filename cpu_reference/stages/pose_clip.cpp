#include "cpu_reference/stages/pose_clip.h"

#include "cpu_reference/clips/blend.h"

namespace skitter::reference {

Affine clipPose(const ClipTable& table, const AgentBody& body, const Play& play, size_t joint) {
  return glm::mat3_cast(body.orientation) * blended(table, play, joint);
}

Affine plantedPose(const ClipTable& table, const AgentBody& body, const Play& play, size_t joint,
                   const BoneFix& fix) {
  Affine matrix = fix.turn * blended(table, play, joint);
  matrix[3] += fix.move;
  return glm::mat3_cast(body.orientation) * matrix;
}

Affine stumpPose(const ClipTable& table, const AgentBody& body, const Play& play, size_t leg, size_t bone,
                 const BoneFix& fix) {
  const glm::dvec3 start = blendedJoints(table, play, leg)[bone];
  Affine matrix(0);
  matrix[3] = body.orientation * (fix.turn * start + fix.move);
  return matrix;
}

}  // namespace skitter::reference

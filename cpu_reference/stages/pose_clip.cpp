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

}  // namespace skitter::reference

#include "app/run/placed_bone.h"

#include <algorithm>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "crowd/controller.h"
#include "skitter/records.h"

namespace skitter::app {
namespace {

PlacedBone placedByPose(const float* pose) {
  return {{pose[4], pose[5], pose[6]}, {pose[0], pose[1], pose[2], pose[3]}};
}

// The matrix's columns may be scaled.
PlacedBone placedByMatrix(const float* rows, const glm::vec3& start) {
  glm::mat3 turn;
  PlacedBone placed{};
  for (int r = 0; r < 3; ++r) {
    const float* row = rows + 4 * r;
    placed.start[r] = row[0] * start.x + row[1] * start.y + row[2] * start.z + row[3];
    for (int c = 0; c < 3; ++c) turn[c][r] = row[c];
  }
  for (int c = 0; c < 3; ++c) turn[c] = glm::normalize(turn[c]);
  const glm::quat q = glm::normalize(glm::quat_cast(turn));
  const float xyzw[4] = {q.x, q.y, q.z, q.w};
  std::copy(xyzw, xyzw + 4, placed.rotation);
  return placed;
}

}  // namespace

PlacedBone placedBone(const HerdState& state, const crowd::Kind& kind, size_t agent, size_t leg,
                      size_t bone) {
  using namespace shared;
  if (!crowd::traitsOf(kind.controller).playsClips) {
    const size_t entry = 1 + leg * static_cast<size_t>(kind.bones) + bone;
    return placedByPose(
        &state.pose[4 * (agent * static_cast<size_t>(kind.rig.paletteSize()) + entry) * POSE_STRIDE]);
  }
  const ClipLeg& chain = kind.clipSet.legs[leg];
  const size_t entry = agent * static_cast<size_t>(kind.clips.joints) + chain.joints[bone];
  return placedByMatrix(&state.pose[4 * entry * MATRIX_STRIDE], chain.starts[bone]);
}

}  // namespace skitter::app

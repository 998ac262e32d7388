#include "crowd/places.h"

#include "crowd/controller.h"
#include "skitter/records.h"

namespace skitter::crowd {
namespace {

using namespace skitter::shared;

// The record at vec4 index `at`.
const float* vec4(const std::vector<float>& records, size_t at) { return records.data() + 4 * at; }

glm::quat quaternion(const float* xyzw) { return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]}; }

// The rows of the matrix by which a clip's skin moves what hangs on that joint of the leg.
const float* matrixOf(const HerdState& state, const Kind& kind, size_t agent, size_t leg, size_t joint) {
  const size_t entry = agent * static_cast<size_t>(kind.clips.joints) + kind.clipSet.legs[leg].joints[joint];
  return vec4(state.pose, entry * MATRIX_STRIDE);
}

glm::vec3 placedBy(const float* rows, const glm::vec3& point) {
  glm::vec3 placed;
  for (int r = 0; r < 3; ++r) {
    const float* row = rows + 4 * r;
    placed[r] = row[0] * point.x + row[1] * point.y + row[2] * point.z + row[3];
  }
  return placed;
}

// The matrix's columns may be scaled.
glm::quat rotationOf(const float* rows) {
  glm::mat3 turn;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) turn[c][r] = rows[4 * r + c];
  for (int c = 0; c < 3; ++c) turn[c] = glm::normalize(turn[c]);
  return glm::normalize(glm::quat_cast(turn));
}

}  // namespace

glm::dvec3 bodyPosition(const HerdState& state, size_t agent) {
  const float* body = vec4(state.body, agent * BODY_STRIDE);
  return {double{tileX(body[3])} * TILE_SIZE + body[0], body[1],
          double{tileZ(body[3])} * TILE_SIZE + body[2]};
}

glm::quat bodyRotation(const HerdState& state, size_t agent) {
  return quaternion(vec4(state.body, agent * BODY_STRIDE + 2));
}

PlacedBone placedBone(const HerdState& state, const Kind& kind, size_t agent, size_t leg, size_t bone) {
  if (traitsOf(kind.controller).playsClips) {
    const float* rows = matrixOf(state, kind, agent, leg, bone);
    return {placedBy(rows, kind.clipSet.legs[leg].starts[bone]), rotationOf(rows)};
  }
  const size_t entry = 1 + leg * static_cast<size_t>(kind.bones) + bone;
  const float* pose =
      vec4(state.pose, (agent * static_cast<size_t>(kind.rig.paletteSize()) + entry) * POSE_STRIDE);
  return {{pose[4], pose[5], pose[6]}, quaternion(pose)};
}

glm::vec3 placedTip(const HerdState& state, const Kind& kind, size_t agent, size_t leg) {
  const std::vector<Bone>& bones = kind.rig.legs[leg].bones;
  if (traitsOf(kind.controller).playsClips)
    return placedBy(matrixOf(state, kind, agent, leg, bones.size()),
                    kind.clipSet.legs[leg].starts[bones.size()]);
  const PlacedBone last = placedBone(state, kind, agent, leg, bones.size() - 1);
  return last.start + last.rotation * (bones.back().length * bones.back().direction);
}

}  // namespace skitter::crowd

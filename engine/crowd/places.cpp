#include "crowd/places.h"

#include <span>

#include "crowd/controller.h"
#include "skitter/records.h"

namespace skitter::crowd {
namespace {

// The pose record of an agent.
std::span<const float> poseOf(const HerdState& state, const Kind& kind, size_t agent) {
  const int stride = shared::poseStride(kind.legs, kind.bones, kind.clips.joints);
  const auto floats = static_cast<size_t>(4 * stride);
  return std::span(state.pose).subspan(agent * floats, floats);
}

// Where the clips' skin takes the start of a leg's bone, or its foot.
BonePose placedByClip(std::span<const float> pose, const ClipLeg& leg, size_t joint) {
  glm::mat4x3 matrix = glm::transpose(jointRowsOf(pose, leg.joints[joint]));
  BonePose placed;
  placed.position = matrix * glm::vec4(leg.starts[joint], 1);
  // Its columns may be scaled.
  glm::mat3 turn(matrix);
  for (int c = 0; c < 3; ++c) turn[c] = glm::normalize(turn[c]);
  placed.rotation = glm::normalize(glm::quat_cast(turn));
  return placed;
}

}  // namespace

BonePose placedBone(const HerdState& state, const Kind& kind, size_t agent, size_t leg, size_t bone) {
  const std::span<const float> pose = poseOf(state, kind, agent);
  if (traitsOf(kind.controller).playsClips) return placedByClip(pose, kind.clipSet.legs[leg], bone);
  return bonePoseOf(pose, static_cast<uint32_t>(1 + leg * static_cast<size_t>(kind.bones) + bone));
}

glm::vec3 placedTip(const HerdState& state, const Kind& kind, size_t agent, size_t leg) {
  const std::vector<Bone>& bones = kind.rig.legs[leg].bones;
  if (traitsOf(kind.controller).playsClips)
    return placedByClip(poseOf(state, kind, agent), kind.clipSet.legs[leg], bones.size()).position;
  const BonePose last = placedBone(state, kind, agent, leg, bones.size() - 1);
  return last.position + last.rotation * (bones.back().length * bones.back().direction);
}

}  // namespace skitter::crowd

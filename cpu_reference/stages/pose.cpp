#include "cpu_reference/stages/pose.h"

namespace skitter::reference {

BonePose bodyPose(const AgentBody& body) { return {body.orientation, glm::dvec3(0)}; }

std::vector<BonePose> pose(const Limb& limb, const AgentBody& body,
                           const std::vector<glm::dvec2>& directions) {
  std::vector<BonePose> entries;
  glm::dquat rotation = body.orientation;
  glm::dvec3 position = body.orientation * limb.root;
  for (size_t i = 0; i < limb.bones.size(); ++i) {
    // Lost bones have neither turn nor length.
    if (i >= limb.left) {
      entries.push_back({rotation, position, true});
      continue;
    }
    const BoneRest& bone = limb.bones[i];
    const glm::dvec3 axis = bone.frame * glm::dvec3(-directions[i].y, directions[i].x, 0);
    rotation = rotation * glm::normalize(glm::dquat(1, axis.x, axis.y, axis.z));
    entries.push_back({rotation, position});
    position += bone.length * limb.reach * (rotation * bone.direction());
  }
  return entries;
}

}  // namespace skitter::reference

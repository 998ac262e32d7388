#include "crowd/rig_records.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "crowd/leg_order.h"
#include "shared/records.h"

namespace skitter::crowd {
namespace {

// Stereographic coordinates are singular at a half-angle of pi: a bone without a limit gets 3 radians.
constexpr float kWidestCone = 3.0f;

void append(std::vector<float>& records, const glm::vec3& v, float w) {
  records.insert(records.end(), {v.x, v.y, v.z, w});
}

// The x axis of the frame B whose z axis is `direction`: the shortest rotation of z onto it, applied to x.
glm::vec3 frameX(const glm::vec3& direction) {
  if (direction.z < -0.999999f) return {1, 0, 0};
  const float k = 1 / (1 + direction.z);
  return glm::normalize(
      glm::vec3(1 - direction.x * direction.x * k, -direction.x * direction.y * k, -direction.x));
}

}  // namespace

std::vector<float> rigRecords(const Rig& rig) {
  std::vector<float> records;
  const std::vector<LegOrder> order = legOrder(rig);
  for (size_t l = 0; l < rig.legs.size(); ++l) {
    const Leg& leg = rig.legs[l];
    append(records, leg.root(), leg.reach);
    append(records, leg.home, static_cast<float>(leg.group));
    append(records, {order[l].lag, static_cast<float>(order[l].neighbours), 1 / leg.reach}, 0);
    glm::mat3 before(1);
    for (int i = 0; i < rig.maxBones(); ++i) {
      const bool present = i < static_cast<int>(leg.bones.size());
      const Bone& bone = present ? leg.bones[static_cast<size_t>(i)] : leg.bones.back();
      // Measured from the records, the frame must be exactly what the solver uses: x orthogonal to z.
      glm::vec3 x = frameX(bone.direction);
      x = glm::normalize(x - bone.direction * glm::dot(x, bone.direction));
      const float half = std::min(bone.coneHalfAngle, kWidestCone) / 2;
      const float length = present ? bone.length / leg.reach : 0.0f, edge = present ? std::tan(half) : 0.0f;
      append(records, x, length);
      append(records, bone.direction, edge);
      append(records, present ? bone.start : leg.home, i == 0 ? shared::FIRST_STIFFNESS : 1.0f);
      append(records, glm::vec3(0), 0);
      append(records, glm::vec3(shared::LIMIT_CONE, 0, 0), 0);
      const glm::mat3 frame(x, glm::cross(bone.direction, x), bone.direction);
      const glm::mat3 carry = glm::transpose(before) * frame;
      append(records, carry[0], length);
      append(records, carry[2], edge);
      before = frame;
    }
  }
  return records;
}

}  // namespace skitter::crowd

#include "crowd/rig_records.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "crowd/leg_order.h"
#include "skitter/records.h"

namespace skitter::crowd {
namespace {

// Stereographic coordinates are singular at a half-angle of pi: a bone without a limit gets 3 radians.
constexpr float kWidestCone = 3.0f;

void append(std::vector<float>& records, const glm::vec3& v, float w) {
  records.insert(records.end(), {v.x, v.y, v.z, w});
}

// Stereographic coordinates of a direction. Its opposite has none: there, what is next to nothing away from
// it.
glm::dvec2 stereographic(const glm::dvec3& d) {
  return 1 + d.z < 1e-9 ? glm::dvec2(0, 1e5) : glm::dvec2(d) / (1 + d.z);
}

// The shortest rotation of z onto the direction that has them.
glm::dmat3 shortest(const glm::dvec2& s) {
  const glm::dvec3 w = glm::dvec3(s, 1) * (2 / (1 + glm::dot(s, s)));
  return {glm::dvec3(1, 0, 0) - s.x * w, glm::dvec3(0, 1, 0) - s.y * w, w - glm::dvec3(0, 0, 1)};
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
    glm::dmat3 frame(1);
    for (int i = 0; i < rig.maxBones(); ++i) {
      const bool present = i < static_cast<int>(leg.bones.size());
      const Bone& bone = present ? leg.bones[static_cast<size_t>(i)] : leg.bones.back();
      const float half = std::min(bone.coneHalfAngle, kWidestCone) / 2;
      const float length = present ? bone.length / leg.reach : 0.0f, edge = present ? std::tan(half) : 0.0f;
      // From the coordinates that the solver reads, so that all frames are exactly its own.
      const glm::vec2 s(stereographic(glm::normalize(glm::transpose(frame) * glm::dvec3(bone.direction))));
      const glm::dmat3 carry = shortest(s);
      frame = frame * carry;
      append(records, glm::vec3(frame[0]), length);
      append(records, glm::vec3(frame[2]), edge);
      append(records, present ? bone.start : leg.home, i == 0 ? shared::FIRST_STIFFNESS : 1.0f);
      append(records, glm::vec3(0), 0);
      append(records, glm::vec3(shared::LIMIT_CONE, 0, 0), 0);
      append(records, glm::vec3(carry[0]), length);
      append(records, glm::vec3(carry[2]), edge);
      records.insert(records.end(), {s.x, s.y, length, present ? std::cos(2 * half) : 1.0f});
    }
  }
  return records;
}

}  // namespace skitter::crowd

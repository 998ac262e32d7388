#include "crowd/symmetry.h"

#include <cmath>
#include <optional>

namespace skitter::crowd {
namespace {

// Leg lengths, that left and right may differ by.
constexpr float sameLength = 1e-3f;

bool isMirrored(const Leg& a, const Leg& b, float tolerance) {
  const auto isNear = [&](const glm::vec3& p, const glm::vec3& q) {
    return glm::distance(p, glm::vec3(-q.x, q.y, q.z)) <= tolerance;
  };
  if (a.bones.size() != b.bones.size() || !isNear(a.home, b.home)) return false;
  for (size_t i = 0; i < a.bones.size(); ++i)
    if (!isNear(a.bones[i].start, b.bones[i].start) ||
        std::abs(a.bones[i].length - b.bones[i].length) > tolerance)
      return false;
  return true;
}

}  // namespace

std::vector<size_t> mirroredLegs(const Rig& rig) {
  const float tolerance = sameLength * rig.legLength;
  std::vector<size_t> mirror;
  for (const Leg& leg : rig.legs) {
    std::optional<size_t> image;
    for (size_t other = 0; !image && other < rig.legs.size(); ++other)
      if (isMirrored(leg, rig.legs[other], tolerance)) image = other;
    if (!image) return {};
    mirror.push_back(*image);
  }
  // Legs in one place could take each other's images.
  for (size_t leg = 0; leg < mirror.size(); ++leg)
    if (mirror[mirror[leg]] != leg) return {};
  return mirror;
}

uint32_t mirrored(uint32_t mask, const std::vector<size_t>& legs) {
  uint32_t image = 0;
  for (size_t leg = 0; leg < legs.size(); ++leg)
    if ((mask >> leg & 1u) != 0) image |= 1u << legs[leg];
  return image;
}

RigGait mirrorImage(const RigGait& gait, const std::vector<size_t>& legs) {
  RigGait image = gait;
  image.idle = mirrored(gait.idle, legs);
  image.shift.x = -gait.shift.x;
  for (size_t leg = 0; leg < legs.size(); ++leg) image.turns[legs[leg]] = gait.turns[leg];
  return image;
}

}  // namespace skitter::crowd

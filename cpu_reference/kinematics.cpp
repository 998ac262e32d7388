#include "cpu_reference/kinematics.h"

#include <algorithm>
#include <utility>

namespace skitter::reference {
namespace {

// S(d), the shortest rotation of z onto d.
glm::dmat3 shortestFromZ(const glm::dvec3& d) {
  const double k = 1 / std::max(1 + d.z, 1e-12);
  return {glm::dvec3(1 - k * d.x * d.x, -k * d.x * d.y, -d.x),
          glm::dvec3(-k * d.x * d.y, 1 - k * d.y * d.y, -d.y), d};
}

}  // namespace

glm::dvec2 stereographic(const glm::dvec3& d) { return glm::dvec2(d.x, d.y) / std::max(1 + d.z, 1e-12); }

glm::dvec3 direction(const glm::dvec2& xy) {
  const double square = glm::dot(xy, xy);
  return glm::dvec3(2 * xy.x, 2 * xy.y, 1 - square) / (1 + square);
}

glm::dvec2 clampCone(const glm::dvec2& xy, double tanHalfCone) {
  const double length = glm::length(xy);
  if (length <= tanHalfCone) return xy;
  const double sine = 2 * length / (1 + length * length);
  return sine < 1e-3 ? glm::dvec2(tanHalfCone, 0) : xy * (tanHalfCone / length);
}

Posture::Posture(const Limb& limb, std::vector<glm::dvec2> directions)
    : limb_(&limb),
      directions_(std::move(directions)),
      frames_(limb.bones.size() + 1),
      joints_(limb.bones.size() + 1, glm::dvec3(0)) {
  frames_[0] = limb.bones[0].frame;
  setDirections(std::vector<glm::dvec2>(directions_));
}

void Posture::place(size_t i, const glm::dvec2& xy) {
  directions_[i] = xy;
  const glm::dmat3 placed = frames_[i] * shortestFromZ(direction(xy));  // F_i
  joints_[i + 1] = joints_[i] + limb_->bones[i].length * placed[2];
  if (i + 1 < bones()) {
    frames_[i + 1] = placed * glm::transpose(limb_->bones[i].frame) * limb_->bones[i + 1].frame;
  }
}

void Posture::setDirections(const std::vector<glm::dvec2>& directions) {
  for (size_t i = 0; i < directions.size(); ++i) place(i, directions[i]);
}

}  // namespace skitter::reference

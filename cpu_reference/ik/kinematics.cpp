#include "cpu_reference/ik/kinematics.h"

#include <algorithm>
#include <utility>

#include "cpu_reference/rotation.h"

namespace skitter::reference {
namespace {

// Z(tau) from tan(tau / 2).
glm::dmat3 aboutZ(double tanHalf) {
  const double scale = 1 / (1 + tanHalf * tanHalf);
  const double cosine = (1 - tanHalf * tanHalf) * scale, sine = 2 * tanHalf * scale;
  return {glm::dvec3(cosine, sine, 0), glm::dvec3(-sine, cosine, 0), glm::dvec3(0, 0, 1)};
}

}  // namespace

glm::dvec2 stereographic(const glm::dvec3& d) { return glm::dvec2(d.x, d.y) / std::max(1 + d.z, 1e-12); }

glm::dvec3 direction(const glm::dvec2& xy) {
  const double square = glm::dot(xy, xy);
  return glm::dvec3(2 * xy.x, 2 * xy.y, 1 - square) / (1 + square);
}

Posture::Posture(const std::vector<BoneRest>& bones, Pose pose)
    : bones_(&bones),
      pose_(std::move(pose)),
      frames_(bones.size() + 1),
      turned_(bones.size()),
      joints_(bones.size() + 1, glm::dvec3(0)) {
  if (!bones.empty()) frames_[0] = bones[0].frame;
  setPose(Pose(pose_));
}

Posture::Posture(const Limb& limb, std::vector<glm::dvec2> directions)
    : Posture(limb.bones, {std::move(directions), std::vector(limb.bones.size(), 0.0)}) {}

void Posture::place(size_t i, const glm::dvec2& swing, double twist) {
  pose_.swing[i] = swing;
  pose_.twist[i] = twist;
  turned_[i] = frames_[i] * shortestFromZ(direction(swing)) * aboutZ(twist);
  joints_[i + 1] = joints_[i] + bone(i).length * (turned_[i] * bone(i).along);
  if (i + 1 < bones()) frames_[i + 1] = turned_[i] * glm::transpose(bone(i).frame) * bone(i + 1).frame;
}

void Posture::setPose(const Pose& pose) {
  for (size_t i = 0; i < bones(); ++i) place(i, pose.swing[i], pose.twist[i]);
}

}  // namespace skitter::reference

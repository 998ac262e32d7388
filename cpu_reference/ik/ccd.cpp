#include "cpu_reference/ik/ccd.h"

#include "cpu_reference/rotation.h"

namespace skitter::reference {
namespace {

// A ball's new direction in its frame: the turn that aims the tip at the target carries the bone along.
glm::dvec3 turnedBall(const Posture& posture, size_t i, const glm::dvec3& toTip, const glm::dvec3& toTarget) {
  const glm::dmat3 turn = shortest(normalized(toTip), normalized(toTarget));
  return glm::transpose(posture.frame(i)) * (turn * posture.turned(i)[2]);
}

// A hinge's: the same in the plane across its axis, where the tip and the target are seen at a and b.
glm::dvec3 turnedHinge(const Posture& posture, size_t i, const glm::dvec3& toTip,
                       const glm::dvec3& toTarget) {
  const glm::dmat3& frame = posture.frame(i);
  const glm::dvec3 d = direction(posture.swing(i));
  const glm::dvec2 a{glm::dot(toTip, frame[1]), glm::dot(toTip, frame[2])};
  const glm::dvec2 b{glm::dot(toTarget, frame[1]), glm::dot(toTarget, frame[2])};
  const double both = glm::length(a) * glm::length(b);
  if (glm::length(a) < 1e-6 || glm::length(b) < 1e-6) return d;
  const double cosine = glm::dot(a, b) / both, sine = (a.x * b.y - a.y * b.x) / both;
  return {0, cosine * d.y - sine * d.z, sine * d.y + cosine * d.z};
}

}  // namespace

void ccd(const std::vector<BoneRest>& bones, const glm::dvec3& target, Joints& joints) {
  for (size_t i = bones.size(); i-- > 0;) {
    if (bones[i].length == 0) continue;
    const glm::dvec3 pivot = joints[i];
    const glm::dmat3 turn = shortest(normalized(joints.back() - pivot), normalized(target - pivot));
    for (size_t j = i + 1; j < joints.size(); ++j) joints[j] = pivot + turn * (joints[j] - pivot);
  }
}

void ccd(const glm::dvec3& target, Posture& posture) {
  Arithmetic exact;
  ccd(target, posture, exact);
}

void ccd(const glm::dvec3& target, Posture& posture, Arithmetic& arithmetic) {
  // Joints nearer the base have not moved yet when their turn comes, so that one pass of forward kinematics
  // at the end will do.
  std::vector<glm::dvec2> swings = posture.directions();
  glm::dvec3 tip = posture.tip();
  for (size_t i = posture.bones(); i-- > 0;) {
    const BoneRest& bone = posture.bone(i);
    if (bone.length == 0) continue;
    const glm::dvec3 pivot = posture.joint(i);
    // Every turn rounds where the tip is. A joint close to the tip sees that as a large angle.
    tip += arithmetic.placeErrors();
    const auto turned = bone.kind == LimitKind::hinge ? turnedHinge : turnedBall;
    swings[i] = clampSwing(bone, stereographic(turned(posture, i, tip - pivot, target - pivot)));
    // F_i' F_i^T, of which the twist, kept, cancels out.
    const glm::dmat3 before = posture.frame(i) * shortestFromZ(direction(posture.swing(i)));
    const glm::dmat3 after = posture.frame(i) * shortestFromZ(direction(swings[i]));
    tip = pivot + after * (glm::transpose(before) * (tip - pivot));
  }
  for (size_t i = 0; i < posture.bones(); ++i) posture.place(i, swings[i]);
}

}  // namespace skitter::reference

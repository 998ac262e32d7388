#include "cpu_reference/ik/fabrik.h"

namespace skitter::reference {
namespace {

// The nearest legal swing of bone i that aims it at `aim`, a vector from its joint.
glm::dvec2 aimed(const Posture& posture, size_t i, const glm::dvec3& aim) {
  const BoneRest& bone = posture.bone(i);
  if (bone.length == 0 || glm::length(aim) < 1e-6) return posture.swing(i);
  glm::dvec3 d = glm::transpose(posture.frame(i)) * normalized(aim);
  if (bone.kind == LimitKind::hinge) {
    d.x = 0;
    if (glm::length(d) < 1e-6) return posture.swing(i);
    d = normalized(d);
  }
  return clampSwing(bone, stereographic(d));
}

}  // namespace

Joints tipToBase(const std::vector<BoneRest>& bones, const glm::dvec3& target, const Joints& joints) {
  Joints q(joints.size());
  q.back() = target;
  for (size_t i = bones.size(); i-- > 0;) {
    q[i] = q[i + 1] + bones[i].length * normalized(joints[i] - q[i + 1]);
  }
  return q;
}

void baseToTip(const std::vector<BoneRest>& bones, const Joints& proposed, Joints& joints) {
  const std::vector<glm::dvec3> kept = directionsOf(joints);
  for (size_t i = 0; i < bones.size(); ++i) {
    const glm::dvec3 aim = proposed[i + 1] - joints[i];
    joints[i + 1] = joints[i] + bones[i].length * (glm::length(aim) < 1e-6 ? kept[i] : normalized(aim));
  }
}

void fabrik(const std::vector<BoneRest>& bones, const glm::dvec3& target, Joints& joints) {
  baseToTip(bones, tipToBase(bones, target, joints), joints);
}

void fabrik(const glm::dvec3& target, Posture& posture) {
  Arithmetic exact;
  fabrik(target, posture, exact);
}

void fabrik(const glm::dvec3& target, Posture& posture, Arithmetic& arithmetic) {
  const Joints q = tipToBase(posture.rests(), target, posture.joints());
  for (size_t i = 0; i < posture.bones(); ++i) {
    // Both ends of the aim are rounded places, and a short bone turns far for a small error.
    posture.place(i, aimed(posture, i, q[i + 1] - posture.joint(i) + arithmetic.placeErrors()));
  }
}

}  // namespace skitter::reference

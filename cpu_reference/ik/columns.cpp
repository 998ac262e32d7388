#include "cpu_reference/ik/columns.h"

#include <algorithm>

namespace skitter::reference {
namespace {

JointColumns jointAt(const Posture& posture, size_t i, const glm::dvec3& attached) {
  JointColumns joint;
  joint.swing = posture.swing(i);
  joint.d = direction(joint.swing);
  joint.s = std::hypot(joint.d.x, joint.d.y);
  if (joint.s >= 1e-6) joint.h = glm::dvec2(joint.d.x, joint.d.y) / joint.s;
  joint.twist = posture.twist(i);
  const BoneRest& bone = posture.bone(i);
  if (bone.length == 0) return joint;

  const auto add = [&, r = attached - posture.joint(i)](const glm::dvec3& axis) {
    joint.columns.push_back({.movement = glm::cross(axis, r)});
  };
  const glm::dmat3& a = posture.frame(i);
  if (bone.kind == LimitKind::hinge) {
    add(a[0]);
    return joint;
  }
  const glm::dvec2& h = joint.h;
  add(h.x * a[1] - h.y * a[0]);
  // Twist-free: the frame rolls about the rest direction as the bone goes round it.
  const double tangent = glm::length(joint.swing);
  const glm::dvec3 around = a[2] * tangent - (h.x * a[0] + h.y * a[1]);
  add(bone.kind == LimitKind::free ? around / std::sqrt(1 + tangent * tangent) : around);
  if (bone.twists()) add(posture.turned(i)[2]);
  return joint;
}

glm::dvec2 steppedHinge(const JointColumns& joint) {
  const glm::dvec3& d = joint.d;
  const double x = joint.columns[0].step;
  return stereographic(normalized(glm::dvec3(0, d.y - x * d.z, d.z + x * d.y)));
}

// A radian of the frame's rotation either way: the quaternion (1, -Y, X, 0) / |..|, up to its sign.
glm::dvec2 steppedFree(const JointColumns& joint) {
  const double x0 = joint.columns[0].step, x1 = joint.columns[1].step, tangent = glm::length(joint.swing);
  const glm::dvec2 &h = joint.h, around(-h.y, h.x);
  const glm::dvec2 to = joint.swing + (x0 * h + x1 * std::sqrt(1 + tangent * tangent) * around) / 2.0;
  const double w = 1 - x0 * tangent / 2, least = glm::length(to) / widestFree;
  return to / (std::abs(w) < least ? std::copysign(least, w) : w);
}

glm::dvec2 steppedBall(const JointColumns& joint) {
  const glm::dvec3& d = joint.d;
  const glm::dvec2 &h = joint.h, &way = joint.way;
  const double x0 = joint.columns[0].step, x1 = joint.columns[1].step;
  const double radial = way.x * x0 - way.y * x1, tangential = way.y * x0 + way.x * x1;
  return stereographic(normalized(d + radial * glm::dvec3(h.x * d.z, h.y * d.z, -joint.s) +
                                  tangential * glm::dvec3(-h.y, h.x, 0)));
}

// tan((tau + 2 atan(x / 2)) / 2), an end of the range where that goes past half a turn.
double steppedTwist(const BoneRest& bone, double tanHalf, double step) {
  const double x = std::clamp(step, -1.0, 1.0);
  const double denominator = 1 - tanHalf * x / 2;
  if (denominator < 0.1) return x > 0 ? bone.tanHalfTwistHigh : bone.tanHalfTwistLow;
  return (tanHalf + x / 2) / denominator;
}

}  // namespace

std::vector<JointColumns> columnsAt(const Posture& posture, const glm::dvec3& attached) {
  std::vector<JointColumns> joints;
  for (size_t i = 0; i < posture.bones(); ++i) joints.push_back(jointAt(posture, i, attached));
  return joints;
}

void pullToRest(const BoneRest& bone, double share, JointColumns& joint) {
  if (joint.columns.empty()) return;
  if (bone.kind == LimitKind::hinge) {
    joint.columns[0].pull = share * joint.d.y;  // sin(-q)
  } else {
    joint.columns[0].pull = joint.way.x * (-share * joint.s);
    joint.columns[1].pull = -joint.way.y * (-share * joint.s);
  }
}

void applySteps(const std::vector<JointColumns>& joints, Posture& posture) {
  for (size_t i = 0; i < joints.size(); ++i) {
    const JointColumns& joint = joints[i];
    const BoneRest& bone = posture.bone(i);
    glm::dvec2 swing = posture.swing(i);
    double twist = posture.twist(i);
    if (!joint.columns.empty()) {
      swing = bone.kind == LimitKind::hinge  ? steppedHinge(joint)
              : bone.kind == LimitKind::free ? steppedFree(joint)
                                             : steppedBall(joint);
      swing = clampSwing(bone, swing);
    }
    if (joint.columns.size() == 3) {
      twist = clampTwist(bone, steppedTwist(bone, joint.twist, joint.columns[2].step));
    }
    posture.place(i, swing, twist);
  }
}

}  // namespace skitter::reference

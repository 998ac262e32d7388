#include "cpu_reference/ik/deadlock.h"

#include "cpu_reference/rotation.h"

namespace skitter::reference {
namespace {

bool isLocked(const Joints& joints, const glm::dvec3& target, Arithmetic& arithmetic) {
  const glm::dvec3 line = normalized(joints.back());
  for (size_t i = 1; i + 1 < joints.size(); ++i) {
    const double away = glm::length(joints[i] - line * glm::dot(joints[i], line));
    if (!arithmetic.below(away + arithmetic.placeError(), 1e-3)) return false;
  }
  return arithmetic.below(glm::length(target), 0.999 * glm::length(joints.back()));
}

}  // namespace

double arcShare(size_t i, size_t n) {
  return n > 1 ? 1 - 2 * static_cast<double>(i) / static_cast<double>(n - 1) : 0;
}

void breakDeadlock(const IkChain& chain, const glm::dvec3& target, Joints& joints) {
  Arithmetic exact;
  if (!isLocked(joints, target, exact)) return;
  const glm::dvec3 side = perpendicular(chain.pole.value_or(glm::dvec3(0)), normalized(joints.back()));
  std::vector<glm::dvec3> directions = directionsOf(joints);
  for (size_t i = 0; i < directions.size(); ++i) {
    directions[i] = normalized(directions[i] + side * (0.1 * arcShare(i, directions.size())));
  }
  joints = laidOut(chain.bones, directions);
}

void breakDeadlock(const glm::dvec3& target, Posture& posture) {
  Arithmetic exact;
  breakDeadlock(target, posture, exact);
}

void breakDeadlock(const glm::dvec3& target, Posture& posture, Arithmetic& arithmetic) {
  if (!isLocked(posture.joints(), target, arithmetic)) return;
  for (size_t i = 0; i < posture.bones(); ++i) {
    const double bend = i == 0 ? -0.025 * static_cast<double>(posture.bones() - 1) : 0.05;
    const BoneRest& bone = posture.bone(i);
    const glm::dvec2 way = bone.kind == LimitKind::hinge ? glm::dvec2(0, 1) : glm::dvec2(1, 0);
    const glm::dvec2 swing = bone.length == 0 ? posture.swing(i) : posture.swing(i) + bend * way;
    posture.place(i, clampSwing(bone, swing));
  }
}

void breakDeadlock(const IkChain& chain, const glm::dvec3& target, IkState& state) {
  if (state.pose.swing.empty()) return breakDeadlock(chain, target, state.joints);
  Posture posture(chain.bones, state.pose);
  breakDeadlock(target, posture);
  state.pose = posture.pose();
  state.joints = posture.joints();
}

}  // namespace skitter::reference

#include "cpu_reference/ik/dissertation.h"

#include <optional>

#include "cpu_reference/rotation.h"

namespace skitter::reference {
namespace {

// The legal direction next to `u` (a bone's, base to tip) for a cone about `axis`; none where it must keep
// its place.
std::optional<glm::dvec3> legal(OutOfCone then, const glm::dvec3& u, const glm::dvec3& axis,
                                const Limit& cone) {
  const double t = cone.tanHalfCone, sine = 2 * t / (1 + t * t), cosine = (1 - t * t) / (1 + t * t);
  if (cone.kind == LimitKind::free || glm::dot(u, axis) >= cosine) return u;
  if (then == OutOfCone::keep) return std::nullopt;
  return axis * cosine + perpendicular(u, axis) * sine;
}

// The direction of a bone between two joints, of one without length the one that it would have at rest.
glm::dvec3 directionFrom(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& axis) {
  return glm::length(to - from) > 0 ? normalized(to - from) : axis;
}

Joints tipToBase(OutOfCone then, const std::vector<BoneRest>& bones, const glm::dvec3& target,
                 const Joints& joints) {
  Joints q(joints.size());
  q.back() = target;
  glm::dvec3 beyond(0);  // the direction of the bone beyond bone i
  for (size_t i = bones.size(); i-- > 0;) {
    const glm::dvec3 proposed = -normalized(joints[i] - q[i + 1]);
    std::optional<glm::dvec3> u = proposed;
    glm::dvec3 axis = proposed;
    if (i + 1 < bones.size()) {
      axis = shortest(bones[i + 1].direction(), beyond) * bones[i].direction();
      u = legal(then, proposed, axis, bones[i + 1]);
    }
    q[i] = u ? q[i + 1] - bones[i].length * *u : joints[i];
    beyond = directionFrom(q[i], q[i + 1], axis);
  }
  return q;
}

Joints baseToTip(OutOfCone then, const std::vector<BoneRest>& bones, const Joints& q) {
  Joints joints(q.size(), glm::dvec3(0));
  glm::dvec3 before(0);  // the direction of the bone before bone i
  for (size_t i = 0; i < bones.size(); ++i) {
    const glm::dvec3 rest = bones[i].direction();
    const glm::dvec3 axis = i == 0 ? rest : shortest(bones[i - 1].direction(), before) * rest;
    const std::optional<glm::dvec3> u = legal(then, normalized(q[i + 1] - joints[i]), axis, bones[i]);
    joints[i + 1] = u ? joints[i] + bones[i].length * *u : q[i + 1];
    before = directionFrom(joints[i], joints[i + 1], axis);
  }
  return joints;
}

}  // namespace

void dissertation(OutOfCone then, const std::vector<BoneRest>& bones, const glm::dvec3& target,
                  Joints& joints) {
  if (glm::length(target) > 1) {
    joints = laidOut(bones, std::vector(bones.size(), normalized(target)));
  } else {
    joints = baseToTip(then, bones, tipToBase(then, bones, target, joints));
  }
}

}  // namespace skitter::reference

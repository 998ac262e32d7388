#include "cpu_reference/ik/chain.h"

#include <algorithm>
#include <stdexcept>

#include "cpu_reference/rotation.h"

namespace skitter::reference {
namespace {

constexpr size_t mostBones = 15;

glm::dvec3 unit(const glm::dvec3& v, const char* what) {
  const double length = glm::length(v);
  if (!(length > 0) || !std::isfinite(length))
    throw std::invalid_argument(std::string(what) + " must not be 0");
  return v / length;
}

// B_i of a ball joint.
glm::dmat3 ballFrame(const glm::dvec3& rest) {
  glm::dvec3 x = rest.z < -0.999999 ? glm::dvec3(1, 0, 0) : shortestFromZ(rest)[0];
  x = glm::normalize(x - rest * glm::dot(x, rest));
  return {x, glm::cross(rest, x), rest};
}

// B_i and o_i of a hinge.
void setHinge(BoneRest& bone, const glm::dvec3& axis, const glm::dvec3& rest) {
  const double c = glm::dot(axis, rest);
  if (std::abs(c) > 0.999) throw std::invalid_argument("a hinge's bone lies along its axis");
  const glm::dvec3 z = glm::normalize(rest - axis * c);
  bone.frame = {axis, glm::cross(z, axis), z};
  bone.along = {c, 0, std::sqrt(1 - c * c)};
}

BoneRest boneRest(const IkBone& given, double total) {
  BoneRest bone;
  static_cast<Limit&>(bone) = given.limit;
  bone.length = given.length / total;
  bone.stiffness = given.stiffness;
  const glm::dvec3 rest = unit(given.direction, "a rest direction");
  if (given.limit.kind == LimitKind::hinge) {
    setHinge(bone, unit(given.hingeAxis, "a hinge's axis"), rest);
  } else {
    bone.frame = ballFrame(rest);
  }
  return bone;
}

// A twist range is a limit too: without one the twist is held at 0.
bool isFree(const Limit& limit) {
  return limit.kind == LimitKind::free && limit.tanHalfTwistLow == 0 && limit.tanHalfTwistHigh == 0;
}

}  // namespace

IkChain makeIkChain(const std::vector<IkBone>& bones, const std::optional<glm::dvec3>& pole) {
  if (bones.empty() || bones.size() > mostBones) throw std::invalid_argument("a chain has 1 to 15 bones");
  IkChain chain;
  for (const IkBone& bone : bones) {
    if (!(bone.length >= 0)) throw std::invalid_argument("a bone's length must be at least 0");
    chain.length += bone.length;
    chain.free = chain.free && isFree(bone.limit);
  }
  if (!(chain.length > 0) || !std::isfinite(chain.length)) {
    throw std::invalid_argument("a chain's length must be above 0");
  }
  for (const IkBone& bone : bones) chain.bones.push_back(boneRest(bone, chain.length));
  if (pole) chain.pole = unit(*pole, "a pole");
  return chain;
}

Pose clamped(const std::vector<BoneRest>& bones, const Pose& pose) {
  Pose legal = pose;
  for (size_t i = 0; i < bones.size(); ++i) {
    legal.swing[i] = clampSwing(bones[i], pose.swing[i]);
    legal.twist[i] = clampTwist(bones[i], pose.twist[i]);
  }
  return legal;
}

IkState stateAt(const IkChain& chain, const Pose& pose) {
  const Posture posture(chain.bones, clamped(chain.bones, pose));
  return {posture.pose(), posture.joints()};
}

IkState restState(const IkChain& chain) {
  if (!chain.free) return stateAt(chain, Pose::rest(chain.bones.size()));
  std::vector<glm::dvec3> directions;
  for (const BoneRest& bone : chain.bones) directions.push_back(bone.direction());
  return {{}, laidOut(chain.bones, directions)};
}

std::vector<glm::dvec3> directionsOf(const Joints& joints) {
  std::vector<glm::dvec3> directions;
  for (size_t i = 0; i + 1 < joints.size(); ++i) directions.push_back(normalized(joints[i + 1] - joints[i]));
  return directions;
}

Joints laidOut(const std::vector<BoneRest>& bones, const std::vector<glm::dvec3>& directions) {
  Joints joints{glm::dvec3(0)};
  for (size_t i = 0; i < bones.size(); ++i) joints.push_back(joints[i] + bones[i].length * directions[i]);
  return joints;
}

std::vector<glm::dmat3> rotationsOf(const IkChain& chain, const Pose& pose) {
  const Posture posture(chain.bones, pose);
  std::vector<glm::dmat3> rotations;
  for (size_t i = 0; i < chain.bones.size(); ++i) rotations.push_back(posture.rotation(i));
  return rotations;
}

std::vector<glm::dmat3> rotationsOf(const IkChain& chain, const Joints& joints) {
  const std::vector<glm::dvec3> directions = directionsOf(joints);
  std::vector<glm::dmat3> rotations;
  glm::dmat3 before(1);
  for (size_t i = 0; i < chain.bones.size(); ++i) {
    before = shortest(before * chain.bones[i].direction(), directions[i]) * before;
    rotations.push_back(before);
  }
  return rotations;
}

}  // namespace skitter::reference

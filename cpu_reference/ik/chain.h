#pragma once

#include <optional>

#include "cpu_reference/ik/kinematics.h"

// A chain of docs/ik.md. Lengths are shares of its total length, the base is at 0, angles are radians.
namespace skitter::reference {

struct IkBone {
  double length = 0;              // any unit, at least 0; a bone of length 0 never turns
  glm::dvec3 direction{0, 0, 1};  // r_i, need not be unit
  Limit limit = freeLimit();
  glm::dvec3 hingeAxis{1, 0, 0};  // need not be unit
  double stiffness = 1;           // of the rest pull
};

// p_0 .. p_n: the state of a chain without limits.
using Joints = std::vector<glm::dvec3>;

struct IkChain {
  std::vector<BoneRest> bones;
  double length = 0;  // of all bones, in the unit that they were given in
  bool free = true;   // no bone is limited: the joints are the state
  std::optional<glm::dvec3> pole;
  std::vector<Pose> seeds;  // where a limited chain starts anew
};

// What a solve moves: a free chain its joints, a limited one its pose, of which the joints follow.
struct IkState {
  Pose pose;
  Joints joints;
  double damping = 1;  // of the active set, [1, 4096]; a solve that continues another takes it over

  double error(const glm::dvec3& target) const { return glm::length(target - joints.back()); }
};

// 1 to 15 bones; the pole, if any, need not be unit. std::invalid_argument where there are more or none, a
// length is negative or all are 0, a direction or axis is 0, or a hinge's bone lies along its axis (|cosine|
// > 0.999).
IkChain makeIkChain(const std::vector<IkBone>& bones, const std::optional<glm::dvec3>& pole = {});

// `pose` within the limits.
Pose clamped(const std::vector<BoneRest>& bones, const Pose& pose);

IkState restState(const IkChain& chain);
// A limited chain's state from its pose, which is clamped.
IkState stateAt(const IkChain& chain, const Pose& pose);

// u_i: the bones' unit directions; 0 for a bone without length.
std::vector<glm::dvec3> directionsOf(const Joints& joints);
// The joints of bones along unit `directions`.
Joints laidOut(const std::vector<BoneRest>& bones, const std::vector<glm::dvec3>& directions);

// R_i: each bone's rotation from rest. By joints, no bone twists against the one before it.
std::vector<glm::dmat3> rotationsOf(const IkChain& chain, const Pose& pose);
std::vector<glm::dmat3> rotationsOf(const IkChain& chain, const Joints& joints);

}  // namespace skitter::reference

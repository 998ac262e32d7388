#pragma once

#include "assets/rigs/body_plan.h"

namespace skitter {

// Leaves out what joint names call arms, fingers, weapons, tails.
void dropNamedLimbs(BodyPlan& plan);

// Finds the mirrored pairs: by where limbs leave the body and how long their bones are, so that a model may
// rest in mid-stride. A limb without a partner stays if it is built like one that has a partner, and if no
// limb has one; else it is a tail or an arm, and is left out. Needs the axis across the body.
void pairLimbs(BodyPlan& plan);

// How the limbs would pair across a plane with this normal.
struct Pairing {
  double share = 0;   // of the limbs that have a partner, 0 to 1
  double middle = 0;  // where along the normal the plane is
};
Pairing pairingAcross(const BodyPlan& plan, const glm::dvec3& side);

struct LimbName {
  std::string name, group;  // L1, A
};
// Sorts the limbs front to back, L1, R1, L2, R2, ..., and names each. Along a side groups alternate, across
// they are opposite: trot, tripod, tetrapod.
std::vector<LimbName> nameLimbs(BodyPlan& plan);

// Whether there are as many legs, and of as many bones, as a rig can have; notes say why not.
bool canWalk(BodyPlan& plan);

}  // namespace skitter

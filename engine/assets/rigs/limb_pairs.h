#pragma once

#include "assets/rigs/body_plan.h"

namespace skitter {

// Legs come in mirrored pairs where any do; what has no partner is a tail or an arm, and is left out. Needs
// the body's axes.
void pairLimbs(BodyPlan& plan);

struct LimbName {
  std::string name, group;  // L1, A
};
// Sorts the limbs front to back, L1, R1, L2, R2, ..., and names each. Along a side groups alternate, across
// they are opposite: trot, tripod, tetrapod.
std::vector<LimbName> nameLimbs(BodyPlan& plan);

// Whether there are as many legs, and of as many bones, as a rig can have; notes say why not.
bool canWalk(BodyPlan& plan);

}  // namespace skitter

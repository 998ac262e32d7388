#pragma once

#include "assets/rigs/body_plan.h"

namespace skitter {

// Finds the chains that may be legs, along the way up that has them.
void chooseUp(BodyPlan& plan);

// Which way along the body is forward, by the first evidence there is: joint names, else symmetry. Needs
// limbs.
void chooseForward(BodyPlan& plan);

// "+X" for an axis, else three numbers.
std::string describe(const glm::dvec3& direction);

}  // namespace skitter

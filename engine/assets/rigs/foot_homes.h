#pragma once

#include "assets/rigs/body_plan.h"

namespace skitter {

struct FootHomes {
  std::vector<glm::dvec3> homes;  // where each limb's foot stands
  glm::dvec3 origin{0};           // on the ground, amid them and in the body's middle
};
// Where the ground is, and where feet stand on it: no leg straighter than 0.75 of its reach.
FootHomes placeFeet(BodyPlan& plan);

}  // namespace skitter

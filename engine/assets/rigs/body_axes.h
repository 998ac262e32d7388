#pragma once

#include <optional>

#include "assets/rigs/body_plan.h"

namespace skitter {

// Finds the chains that may be legs, along the way up that has them.
void chooseUp(BodyPlan& plan);

// The axis across the body, as `left` or its opposite: by names of left and right, else by symmetry. Needs
// limbs.
void findAcross(BodyPlan& plan);

// Which way along the body is forward: a vote of clips, toes, names of head, tail, front, back, left and
// right, knees and pole targets. `given` overrules it. Needs pairs and soles.
void chooseForward(BodyPlan& plan, const std::optional<glm::dvec3>& given);

// "+X" for an axis, else three numbers.
std::string describe(const glm::dvec3& direction);

}  // namespace skitter

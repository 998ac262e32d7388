#pragma once

#include "assets/rigs/body_plan.h"

namespace skitter {

// Feet that lie on the ground: such a leg ends with one bone, from the ankle to the middle of the sole, whose
// skin keeps its shape. Needs pairs.
void findSoles(BodyPlan& plan);

}  // namespace skitter

#pragma once

#include "assets/rigs/body_plan.h"

namespace skitter {

// Which way a model's clips walk along an axis: 1 along it, -1 against it, 0 where none walks. Feet that
// stand go backward under the body, in clips on the spot, too; else the body itself goes.
double headingOfClips(const BodyPlan& plan, const glm::dvec3& axis);

}  // namespace skitter

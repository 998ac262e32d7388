#pragma once

#include <vector>

#include "skitter/rig.h"

namespace skitter {

// Half-angles in degrees, one a bone. A joint that is bent at rest may straighten and fold as much again, so
// it cannot turn over; joints that are all but straight are widened until the leg folds to a quarter of its
// reach, and all are where it could not fold by half. The first joint turns the leg. The last `footBones`
// bones are a foot, which turns at the ankle but does not fold.
std::vector<double> conesOf(const Leg& leg, size_t footBones = 0);

}  // namespace skitter

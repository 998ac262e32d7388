#pragma once

#include <vector>

#include "skitter/rig.h"

namespace skitter {

// Half-angles in degrees, one a bone. Each joint may straighten what it bends at rest and fold as much again,
// and further where the leg could not fold to a quarter of its reach; the first joint turns the leg.
std::vector<double> conesOf(const Leg& leg);

}  // namespace skitter

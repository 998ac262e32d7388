#pragma once

#include "cpu_reference/stages/adapt.h"
#include "crowd/gait_map.h"

// Maps of gaits that are made of numbers.
namespace skitter::test {

// The creature's own gait, and one of it without each leg, in which all others stand for 0.6 of the time. f
// is 1, and then less by 0.05 from leg to leg.
reference::GaitMap oneLegMap(const reference::Creature& creature);

// Its records (shaders/shared/adapt.h), without the rows of the kernel: the reference has its own.
crowd::GaitMap recordsOf(const reference::GaitMap& map);

}  // namespace skitter::test

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "skitter/rig.h"

namespace skitter::crowd {

// Each leg's mirror image in the plane between left and right, which may be itself: the leg whose root and
// home are where the mirror has them, to a thousandth of a leg length, and whose bones are as long. Empty for
// a rig that is no mirror image of itself.
std::vector<size_t> mirroredLegs(const Rig& rig);

// The mask of the legs' mirror images.
uint32_t mirrored(uint32_t mask, const std::vector<size_t>& legs);
// The gait with left and right exchanged.
RigGait mirrorImage(const RigGait& gait, const std::vector<size_t>& legs);

}  // namespace skitter::crowd

#pragma once

#include <cstdint>
#include <vector>

#include "skitter/rig.h"

namespace skitter::evolve {

// The masks of idle legs that are searched, in ascending order: of a pattern and its mirror image the smaller
// one (docs/evolve.md).
std::vector<uint32_t> patternsOf(const Rig& rig);

}  // namespace skitter::evolve

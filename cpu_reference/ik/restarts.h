#pragma once

#include "cpu_reference/ik/solve.h"

namespace skitter::reference {

// The active set's solve of a limited chain: attempts from the start pose and from seeds, because limits
// leave local minima. `start` is legal, `target` finite. `jumped`: whether one from a seed replaced the
// first attempt's pose.
IkResult solveWithRestarts(const IkChain& chain, const IkSettings& settings, const glm::dvec3& target,
                           const IkState& start, IkMemory& memory, bool& jumped);

}  // namespace skitter::reference

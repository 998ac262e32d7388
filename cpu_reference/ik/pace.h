#pragma once

#include "cpu_reference/ik/solve.h"

namespace skitter::reference {

// The way of a target, in a solve, from which on its chain may leave its pose for little, and is not held.
inline constexpr double fastTarget = 0.01;

// Holds a solve that continues another to its target's pace (docs/ik.md, Pace), and has `memory` know the
// target. `jumped`: the pose is a restart's.
void keepPace(const IkChain& chain, const IkSettings& settings, const glm::dvec3& target,
              const IkState& start, bool jumped, IkResult& result, IkMemory& memory);

}  // namespace skitter::reference

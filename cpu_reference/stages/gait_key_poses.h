#pragma once

#include "cpu_reference/types.h"

namespace skitter::reference {

// The phase of key poses: it goes with the way that feet make, one cycle a `stride` of metres. `phase` is the
// last tick's, `body` the new one.
double wheelPhase(const Tuning& tuning, double stride, const AgentBody& body, double phase);

}  // namespace skitter::reference

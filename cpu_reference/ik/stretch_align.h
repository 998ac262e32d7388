#pragma once

#include "cpu_reference/ik/chain.h"

namespace skitter::reference {

// Stretches or folds a free chain along its own line until its tip is as far away as `target`, keeping the
// ways that its bones bend, and turns all of it toward the target. The stretch is the root of a scalar
// equation, found by a bracketed Newton iteration to within 0.9 of `tolerance`; `onward`, one more step is
// made from there. What is left of the error is FABRIK's.
void stretchAlign(const IkChain& chain, const glm::dvec3& target, double tolerance, bool onward,
                  Joints& joints);

}  // namespace skitter::reference

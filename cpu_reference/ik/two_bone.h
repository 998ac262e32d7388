#pragma once

#include "cpu_reference/ik/chain.h"

namespace skitter::reference {

// The law of cosines: brings the tip of a free chain of two bones to `target`, or to the nearest point of the
// way to it that two bones can reach. The middle joint is on the side of the pole, or else on the side where
// it is.
void twoBone(const IkChain& chain, const glm::dvec3& target, Joints& joints);

}  // namespace skitter::reference

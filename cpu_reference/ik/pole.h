#pragma once

#include "cpu_reference/ik/chain.h"

// To which side of the line from base to tip a chain bends.
namespace skitter::reference {

// How far toward the unit `pole`; lengths of the chain, summed over its joints.
double bendToward(const glm::dvec3& pole, const Joints& joints);
// Turns a free chain about the line until it bends toward the pole as far as it can.
void turnToPole(const glm::dvec3& pole, Joints& joints);

}  // namespace skitter::reference

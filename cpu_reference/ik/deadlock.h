#pragma once

#include "cpu_reference/arithmetic.h"
#include "cpu_reference/ik/chain.h"

namespace skitter::reference {

// A straight chain whose target lies nearer along it is a saddle that no solver can leave: a chain whose
// joints are all within 1e-3 of the line from base to tip is bent to an arc, if the target is nearer than its
// tip.
void breakDeadlock(const IkChain& chain, const glm::dvec3& target, Joints& joints);
void breakDeadlock(const glm::dvec3& target, Posture& posture);
// Its decisions are whether each joint in turn is on the line, and whether the target is nearer.
void breakDeadlock(const glm::dvec3& target, Posture& posture, Arithmetic& arithmetic);
void breakDeadlock(const IkChain& chain, const glm::dvec3& target, IkState& state);

// How far bone i of n is turned for an arc: +1 at the base to -1 at the tip; 0 for a single bone.
double arcShare(size_t i, size_t n);

}  // namespace skitter::reference

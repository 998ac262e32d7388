#pragma once

#include <span>
#include <vector>

#include "bench/cpu_crowd/avoid/linear_program.h"
#include "bench/cpu_crowd/avoid/walkers.h"

// What an answer of the linear programs must be, found without them: every vertex is tried. Slow.
namespace skitter::cpu_avoid {

// Half-planes of an agent, of the ten nearest of all others.
std::vector<Allowed> orcaPlanesOf(const Walkers& walkers, size_t agent);
// How fast it may go, m/s.
double orcaSpeedOf(const Walkers& walkers, size_t agent);

// The largest violation by a velocity; 0 where none is violated.
double violationOf(std::span<const Allowed> planes, const Velocity& v);
// The least that this can be for a velocity of the disc.
double leastViolation(std::span<const Allowed> planes, double speed);
// How near to `wanted` a velocity of the disc can be that violates no half-plane; infinite where none does.
double leastDistance(std::span<const Allowed> planes, double speed, const Velocity& wanted);

// By how much a velocity violates a half-plane more than the least that the half-planes and the disc allow,
// or leaves the disc; m/s.
double orcaFault(const Walkers& walkers, size_t agent, const Velocity& v);
// What it is allowed: solved in double, and stored in float at up to 8 m/s.
constexpr double orcaTolerance = 1e-4;

}  // namespace skitter::cpu_avoid

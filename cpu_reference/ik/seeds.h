#pragma once

#include <random>

#include "cpu_reference/ik/chain.h"

namespace skitter::reference {

// Bits are those of the standard's mt19937_64, so that a seed gives the same poses everywhere.
using IkRandom = std::mt19937_64;

// Uniform on the cap of a cone or ellipse, uniform in the angle of a hinge or twist; rest for a bone without
// length.
Pose randomLegalPose(const std::vector<BoneRest>& bones, IkRandom& random);

// Where a limited chain starts anew: at most `count` legal poses whose tips lie far apart, picked out of 1024
// random ones pulled 30 % to rest, but for free bones. Each is picked farthest from the ones before it and
// from rest. Those that are aimed have the first bone at rest, and their tips' distances from the base are
// apart.
std::vector<Pose> makeSeeds(const IkChain& chain, uint64_t seed, size_t count = 64);

// Whether a chain's seeds are shapes, which an attempt turns about the free base to point at its target.
bool aimsSeeds(const IkChain& chain);
// The state of such a chain turned about its base, as far as that may, so that its tip points at `target`.
IkState aimed(const IkChain& chain, const IkState& state, const glm::dvec3& target);

}  // namespace skitter::reference

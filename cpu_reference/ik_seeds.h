#pragma once

#include <random>

#include "cpu_reference/ik_chain.h"

namespace skitter::reference {

// Bits are those of the standard's mt19937_64, so that a seed gives the same poses everywhere.
using IkRandom = std::mt19937_64;

// Uniform on the cap of a cone or ellipse, uniform in the angle of a hinge or twist; rest for a bone without
// length.
Pose randomLegalPose(const std::vector<BoneRest>& bones, IkRandom& random);

// Where a limited chain starts anew: at most `count` legal poses whose tips lie far apart, picked out of 1024
// random ones pulled 30 % to rest, but for free bones. Each is picked farthest from the ones before it and
// from rest.
std::vector<Pose> makeSeeds(const std::vector<BoneRest>& bones, uint64_t seed, size_t count = 64);

}  // namespace skitter::reference

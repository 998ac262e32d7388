#pragma once

#include <glm/glm.hpp>
#include <random>
#include <string>
#include <vector>

#include "cpu_reference/ik/chain.h"
#include "cpu_reference/ik/seeds.h"
#include "skitter/ik.h"

// Chains to be solved, and poses and targets for them.
namespace skitter::test {

using Random = reference::IkRandom;

double uniform(Random& random, double low, double high);
glm::dvec3 randomDirection(Random& random);

// What limits a chain: the kinds of docs/ik.md by their names, "oblique" (hinges that their bones are not
// square to), "twist" (balls that may twist), "mixed" (all of these by turns), "free-base" (a free bone, then
// cones).
extern const std::vector<std::string> limitKinds;

// A chain of random lengths and limits, bent at rest.
ik::Chain randomChain(const std::string& limits, size_t joints, Random& random);
// The same with limits of each bone's own kind: cones of 15 to 100 degrees, ellipses likewise, hinges 20 to
// 150 degrees wide within 130 either way.
ik::Chain randomRig(const std::vector<std::string>& kinds, Random& random);
// Equal bones that add up to 1, each turned by `bend` radians against the one before, by turns this way and
// that.
ik::Chain evenChain(size_t joints, double bend, const ik::Limit& limit = ik::Free{});

reference::IkState randomState(const reference::IkChain& chain, Random& random);
// Where the tip of a random legal pose is, in the chain's lengths.
glm::dvec3 legalTarget(const reference::IkChain& chain, Random& random);

}  // namespace skitter::test

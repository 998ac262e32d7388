#pragma once

#include <vector>

#include "ik/chains.h"

namespace skitter {
class Device;
}

// What a batch makes of many targets, judged by nothing but the joints.
namespace skitter::test {

struct Outcome {
  double solved = 0;     // share of the poses whose tip is within 1e-3 of the reach
  double violation = 0;  // of a limit, largest, radians
  double boneError = 0;  // largest, share of the reach
  double p99Ratio = 0;   // of the farthest joint's way to the target's, tick by tick
  double meanIterations = 0;
};

// A target a tick, in the reach, and where the chain is before the first; nowhere: at rest.
struct Path {
  std::vector<glm::dvec3> targets;
  reference::IkState start;
};

Outcome solveCold(Device& device, const ik::Chain& chain, const ik::Options& options,
                  const std::vector<glm::dvec3>& targets);
// A chain a path; all are as long. The first targets are solved until the chains are there.
Outcome follow(Device& device, const ik::Chain& chain, ik::Options options, const std::vector<Path>& paths);

// Anywhere between two radii.
std::vector<glm::dvec3> shellTargets(double least, double most, size_t count, Random& random);
std::vector<glm::dvec3> legalTargets(const ik::Chain& chain, size_t count, Random& random);

// A step is 2 % of the reach. Through the shell from 0.2 to 0.95, of the tip from legal pose to legal pose
// with the first one given, and round small circles beyond the reach.
std::vector<Path> wanderingPaths(size_t count, size_t ticks, Random& random);
std::vector<Path> legalPaths(const ik::Chain& chain, size_t count, size_t ticks, Random& random);
std::vector<Path> circlesBeyondReach(const ik::Chain& chain, size_t count, size_t ticks, Random& random);

}  // namespace skitter::test

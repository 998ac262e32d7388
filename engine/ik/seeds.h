#pragma once

#include <cstdint>
#include <vector>

#include "ik/skeleton.h"

namespace skitter::ik {

// Poses from which the active set starts anew (docs/ik.md, Restarts): at most `most`, the same for the same
// chain. With a pole, those alone that fold to its side. Those that a solve aims have the first bone at rest.
std::vector<Skeleton::Pose> seedPoses(const Skeleton&, const std::optional<glm::vec3>& pole, uint32_t most);
// Whether a solve turns its seeds about a free base to point at the target.
bool aimsSeeds(const Skeleton&, const std::optional<glm::vec3>& pole);

}  // namespace skitter::ik

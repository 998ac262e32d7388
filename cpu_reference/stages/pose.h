#pragma once

#include "cpu_reference/types.h"

namespace skitter::reference {

// Entry 0 of an agent's pose.
BonePose bodyPose(const AgentBody& body);
// The entries of one leg, root first.
std::vector<BonePose> pose(const Limb& limb, const AgentBody& body,
                           const std::vector<glm::dvec2>& directions);

}  // namespace skitter::reference

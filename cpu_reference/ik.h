#pragma once

#include "cpu_reference/types.h"

namespace skitter::reference {

// `previous` gives the warm start and its damping. A target that is not finite keeps the pose and counts as
// reached.
Chain ik(const Tuning& tuning, const Limb& limb, const AgentBody& body, const Foot& foot,
         const Chain& previous, int fabrikIterations, int polishIterations);

// The target in the limb's own terms: model space with the root at 0, divided by the reach.
glm::dvec3 ikTarget(const Limb& limb, const AgentBody& body, const glm::dvec3& foot);

}  // namespace skitter::reference

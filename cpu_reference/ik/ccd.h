#pragma once

#include "cpu_reference/arithmetic.h"
#include "cpu_reference/ik/chain.h"

namespace skitter::reference {

// One sweep of cyclic coordinate descent (Wang & Chen 1991), tip to base: each joint in turn brings the tip
// as near to `target` as it alone can, within its limit.
void ccd(const std::vector<BoneRest>& bones, const glm::dvec3& target, Joints& joints);
void ccd(const glm::dvec3& target, Posture& posture);
void ccd(const glm::dvec3& target, Posture& posture, Arithmetic& arithmetic);

}  // namespace skitter::reference

#pragma once

#include "cpu_reference/kinematics.h"

namespace skitter::reference {

// One Levenberg-Marquardt step of damped least squares over the joint angles toward `target`, in which a
// joint that meets its limit is held there and what it could not do is handed to the others. A step that
// leaves the tip further away is undone; `damping` is adapted either way. `pulls`: near the target the chain
// is drawn toward its rest pose.
void activeSetStep(const Tuning& tuning, const Limb& limb, const glm::dvec3& target, bool pulls,
                   Posture& posture, double& damping);

}  // namespace skitter::reference

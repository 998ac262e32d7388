#pragma once

#include "cpu_reference/kinematics.h"

namespace skitter::reference {

// One step of damped least squares over the joint angles toward `target`, in which a joint that meets its
// limit is held there and what it could not do is handed to the others, and then `chords` chord steps with
// the same columns and matrix (simplified Newton method). What leaves the tip further away is undone;
// `damping` is adapted either way, as Levenberg and Marquardt do. With `chords` and near the target, the
// chain is also drawn toward its rest pose.
void activeSet(const Tuning& tuning, const Limb& limb, const glm::dvec3& target, int chords, Posture& posture,
               double& damping);

}  // namespace skitter::reference

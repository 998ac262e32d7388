#pragma once

#include "cpu_reference/arithmetic.h"
#include "cpu_reference/ik/kinematics.h"

namespace skitter::reference {

struct ActiveSet {
  double restPull = 0;      // share of the angle from rest that is taken back, times the bone's stiffness
  double pullError = 2e-3;  // it is below this error, share of the reach
  double tolerance = 9e-4;  // a step that ends within it is kept even if it ends further away
  int chords = 0;           // chord steps after the step
  bool ifNear = false;  // of those, none from beyond 0.1 or within the tolerance, and none that leads away;
                        // and more damping out of reach
};

// One step of damped least squares over the joint angles toward `target`, in which a joint that meets its
// limit is held there and what it could not do is handed to the others (active set: Nocedal & Wright, 16.5),
// and then `chords` chord steps with the same columns and matrix (simplified Newton method). What leaves the
// tip further away is undone; `damping`, [1, 4096], is adapted either way, as Levenberg and Marquardt do.
// Its decisions are: whether bones are pulled to rest; of each column that has a limit, pass by pass, whether
// it is held; whether the tip is further away, and beyond the tolerance.
void activeSet(const ActiveSet& how, const glm::dvec3& target, Posture& posture, double& damping);
void activeSet(const ActiveSet& how, const glm::dvec3& target, Posture& posture, double& damping,
               Arithmetic& arithmetic);

}  // namespace skitter::reference

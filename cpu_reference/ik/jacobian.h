#pragma once

#include "cpu_reference/arithmetic.h"
#include "cpu_reference/ik/chain.h"

namespace skitter::reference {

// Buss 2004, "Introduction to inverse kinematics with Jacobian transpose, pseudoinverse and damped least
// squares methods". `targetAttached` is dls with the target carried by the joints in place of the tip. As (t
// - p) x e = (tip - p) x e its gradient J^T e is the same; only the matrix that divides it is another one.
enum class Jacobian { transpose, pseudoinverse, dls, targetAttached };

// One iteration toward `target`. The tip may end up further away than it was.
void jacobian(Jacobian method, const std::vector<BoneRest>& bones, const glm::dvec3& target, Joints& joints);
void jacobian(Jacobian method, const glm::dvec3& target, Posture& posture);
void jacobian(Jacobian method, const glm::dvec3& target, Posture& posture, Arithmetic& arithmetic);

}  // namespace skitter::reference

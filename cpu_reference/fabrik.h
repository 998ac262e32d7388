#pragma once

#include "cpu_reference/kinematics.h"

namespace skitter::reference {

// FABRIK (Aristidou & Lasenby 2011) with cones in carried frames: at most `iterations`, from the posture
// given, while the tip is further than `enough` from `target`. The best posture seen is kept.
void fabrik(const Limb& limb, const glm::dvec3& target, int iterations, double enough, Posture& posture);

}  // namespace skitter::reference

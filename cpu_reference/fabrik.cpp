#include "cpu_reference/fabrik.h"

namespace skitter::reference {

void fabrik(const Limb& limb, const glm::dvec3& target, int iterations, double enough, Posture& posture) {
  const size_t n = posture.bones();
  std::vector<glm::dvec2> best = posture.directions();
  double bestError = glm::length(target - posture.tip());
  double error = bestError;
  std::vector<glm::dvec3> q(n + 1);
  for (int iteration = 0; iteration < iterations && error > enough; ++iteration) {
    q[n] = target;
    for (size_t i = n; i-- > 0;) {
      q[i] = q[i + 1] + limb.bones[i].length * normalized(posture.joint(i) - q[i + 1]);
    }
    for (size_t i = 0; i < n; ++i) {
      glm::dvec2 xy = posture.directions()[i];
      const glm::dvec3 aim = q[i + 1] - posture.joint(i);
      if (limb.bones[i].length > 0 && glm::length(aim) >= 1e-6) {
        const glm::dvec3 d = glm::transpose(posture.frame(i)) * normalized(aim);
        xy = clampCone(stereographic(d), limb.bones[i].tanHalfCone);
      }
      posture.place(i, xy);
    }
    error = glm::length(target - posture.tip());
    if (error < bestError) {
      bestError = error;
      best = posture.directions();
    }
  }
  posture.setDirections(best);
}

}  // namespace skitter::reference

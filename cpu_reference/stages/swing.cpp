#include "cpu_reference/stages/swing.h"

namespace skitter::reference {
namespace {

// One cubic Hermite segment from A with tangent mA to B with tangent mB.
SplinePoint hermite(const glm::dvec3& a, const glm::dvec3& ma, const glm::dvec3& b, const glm::dvec3& mb,
                    double s) {
  const double s2 = s * s, s3 = s2 * s;
  return {(2 * s3 - 3 * s2 + 1) * a + (s3 - 2 * s2 + s) * ma + (-2 * s3 + 3 * s2) * b + (s3 - s2) * mb,
          (6 * s2 - 6 * s) * a + (3 * s2 - 4 * s + 1) * ma + (-6 * s2 + 6 * s) * b + (3 * s2 - 2 * s) * mb};
}

}  // namespace

SplinePoint splineAt(const Step& step, double u) {
  const glm::dvec3 knot = (step.liftOff + step.landing) / 2.0 + step.lift;
  const glm::dvec3 knotTangent = (step.landing - step.liftOff) / 2.0;
  if (u < 0.5) return hermite(step.liftOff, step.startTangent, knot, knotTangent, 2 * u);
  return hermite(knot, knotTangent, step.landing, -step.lift, 2 * u - 1);
}

Eased eased(const Step& step, double u) {
  // A cubic Hermite spline from 0 to 1 that ends at rest, and begins at rest where the step begins on the
  // ground.
  const double g = step.startTangent == step.lift ? 0 : 1;
  const double u2 = u * u, u3 = u2 * u;
  return {(u3 - 2 * u2 + u) * g + (-2 * u3 + 3 * u2), (3 * u2 - 4 * u + 1) * g + (-6 * u2 + 6 * u)};
}

Foot swing(const Step& step, const AgentBody& body, double tick) {
  const double u = step.progress(tick);
  const glm::dvec3 point = u >= 1 ? step.landing : splineAt(step, eased(step, u).progress).position;
  return {step.relative(point, body), u};
}

}  // namespace skitter::reference

#include "cpu_reference/limit.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace skitter::reference {
namespace {

double halfAngle(double angle) {
  if (!(angle > 0)) throw std::invalid_argument("a limit's half-angle must be above 0");
  return std::min(angle, widestAngle);
}

double tanHalf(double angle) {
  if (!std::isfinite(angle)) throw std::invalid_argument("a limit's angle must be finite");
  return std::tan(std::clamp(angle, -widestAngle, widestAngle) / 2);
}

void requireOrder(double low, double high) {
  if (low > high) throw std::invalid_argument("a limit's low end must not be above its high end");
}

// tan(theta_max / 2) toward h.
double edge(const Limit& limit, const glm::dvec2& h) {
  if (limit.kind != LimitKind::ellipse) return limit.tanHalfCone;
  return std::tan(1 / glm::length(h / ellipseAxes(limit, h)) / 2);
}

}  // namespace

Limit freeLimit() {
  Limit limit = coneLimit(widestAngle);
  limit.kind = LimitKind::free;
  return limit;
}

Limit coneLimit(double angle) {
  Limit limit;
  limit.tanHalfCone = tanHalf(halfAngle(angle));
  return limit;
}

Limit ellipseLimit(double positiveX, double positiveY, double negativeX, double negativeY) {
  Limit limit;
  limit.kind = LimitKind::ellipse;
  limit.ellipse = {halfAngle(positiveX), halfAngle(positiveY), halfAngle(negativeX), halfAngle(negativeY)};
  return limit;
}

Limit hingeLimit(double low, double high) {
  requireOrder(low, high);
  Limit limit;
  limit.kind = LimitKind::hinge;
  limit.tanHalfLow = tanHalf(low);
  limit.tanHalfHigh = tanHalf(high);
  return limit;
}

Limit withTwist(Limit limit, double low, double high) {
  requireOrder(low, high);
  limit.tanHalfTwistLow = tanHalf(low);
  limit.tanHalfTwistHigh = tanHalf(high);
  return limit;
}

glm::dvec2 ellipseAxes(const Limit& limit, const glm::dvec2& h) {
  return {h.x >= 0 ? limit.ellipse.x : limit.ellipse.z, h.y >= 0 ? limit.ellipse.y : limit.ellipse.w};
}

glm::dvec2 clampSwing(const Limit& limit, const glm::dvec2& xy) {
  if (limit.kind == LimitKind::hinge) return {0, -std::clamp(-xy.y, limit.tanHalfLow, limit.tanHalfHigh)};
  const double length = glm::length(xy);
  if (length == 0) return xy;
  const double sine = 2 * length / (1 + length * length);
  // Straight against the rest direction every way is as good.
  const bool reversed = sine < 1e-3 && length > 1;
  const double most = edge(limit, reversed ? glm::dvec2(1, 0) : xy / length);
  if (length <= most) return xy;
  return reversed ? glm::dvec2(most, 0) : xy * (most / length);
}

double clampTwist(const Limit& limit, double tanHalfTwist) {
  if (limit.kind == LimitKind::hinge) return 0;
  return std::clamp(tanHalfTwist, limit.tanHalfTwistLow, limit.tanHalfTwistHigh);
}

}  // namespace skitter::reference

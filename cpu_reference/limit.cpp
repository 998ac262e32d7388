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

// The ellipse's half-angles in the quadrant of h.
glm::dvec2 ellipseAxes(const Limit& limit, const glm::dvec2& h) {
  return {h.x >= 0 ? limit.ellipse.x : limit.ellipse.z, h.y >= 0 ? limit.ellipse.y : limit.ellipse.w};
}

// tan(theta_max / 2) toward h.
double edge(const Limit& limit, const glm::dvec2& h) {
  if (limit.kind != LimitKind::ellipse) return limit.tanHalfCone;
  return std::tan(1 / glm::length(h / ellipseAxes(limit, h)) / 2);
}

constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double leastDenominator = 0.1;  // of a room's tangent; below it, the limit is too far to matter

Room coneRoom(const Limit& limit, const glm::dvec3& d, double s) {
  const double t = limit.tanHalfCone, sine = 2 * t / (1 + t * t), cosine = (1 - t * t) / (1 + t * t);
  const double denominator = cosine * d.z + sine * s;
  if (denominator < leastDenominator) return {};
  return {.high = (sine * d.z - cosine * s) / denominator};
}

// Only the way across the level line of E = sqrt((v.x / a_x)^2 + (v.y / a_y)^2), v = theta h, on which the
// bone is, is limited, by E = 1.
Room ellipseRoom(const Limit& limit, const glm::dvec3& d, double s, const glm::dvec2& h) {
  const double theta = 2 * std::atan(s / std::max(1 + d.z, 1e-12));
  if (theta < 1e-3) return {};
  const glm::dvec2 axes = ellipseAxes(limit, h), around{-h.y, h.x};
  const glm::dvec2 v = theta * h, n = v / (axes * axes);
  const double level = std::sqrt(glm::dot(v, n));
  // Gradient of E by (radial, tangential) steps, times E.
  const glm::dvec2 gradient{glm::dot(n, h), glm::dot(n, around) * theta / s};
  const double steepness = glm::length(gradient);
  return {.high = (1 - level) * level / steepness, .way = gradient / steepness};
}

// tan(end - q) from tan(end / 2) and the hinge's d = (0, -sin q, cos q).
double hingeEnd(double tanHalf, const glm::dvec3& d, double otherwise) {
  const double scale = 1 / (1 + tanHalf * tanHalf);
  const double sine = 2 * tanHalf * scale, cosine = (1 - tanHalf * tanHalf) * scale;
  const double denominator = cosine * d.z - sine * d.y;
  return denominator < leastDenominator ? otherwise : (sine * d.z + cosine * d.y) / denominator;
}

// 2 tan((end - tau) / 2).
double twistEnd(double tanHalf, double twist, double otherwise) {
  const double denominator = 1 + tanHalf * twist;
  return denominator < leastDenominator ? otherwise : 2 * (tanHalf - twist) / denominator;
}

}  // namespace

Limit freeLimit() {
  Limit limit;
  limit.kind = LimitKind::free;
  limit.tanHalfCone = widestFree;
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

glm::dvec2 clampSwing(const Limit& limit, const glm::dvec2& xy) {
  if (limit.kind == LimitKind::hinge) return {0, -std::clamp(-xy.y, limit.tanHalfLow, limit.tanHalfHigh)};
  const double length = glm::length(xy);
  if (length == 0) return xy;
  const double sine = 2 * length / (1 + length * length);
  // Straight against the rest direction every way is as good.
  const bool reversed = limit.kind != LimitKind::free && sine < 1e-3 && length > 1;
  const double most = edge(limit, reversed ? glm::dvec2(1, 0) : xy / length);
  if (length <= most) return xy;
  return reversed ? glm::dvec2(most, 0) : xy * (most / length);
}

double clampTwist(const Limit& limit, double tanHalfTwist) {
  if (limit.kind == LimitKind::hinge) return 0;
  return std::clamp(tanHalfTwist, limit.tanHalfTwistLow, limit.tanHalfTwistHigh);
}

double greatestAngle(const Limit& limit) {
  const glm::dvec4& e = limit.ellipse;
  return limit.kind == LimitKind::ellipse ? std::max({e.x, e.y, e.z, e.w}) : 2 * std::atan(limit.tanHalfCone);
}

Room swingRoom(const Limit& limit, const glm::dvec3& d, double s, const glm::dvec2& h) {
  if (limit.kind == LimitKind::hinge)
    return {.low = hingeEnd(limit.tanHalfLow, d, -unlimited),
            .high = hingeEnd(limit.tanHalfHigh, d, unlimited)};
  if (limit.kind == LimitKind::free) return {};
  return limit.kind == LimitKind::ellipse ? ellipseRoom(limit, d, s, h) : coneRoom(limit, d, s);
}

Room twistRoom(const Limit& limit, double twist) {
  return {.low = twistEnd(limit.tanHalfTwistLow, twist, -unlimited),
          .high = twistEnd(limit.tanHalfTwistHigh, twist, unlimited)};
}

}  // namespace skitter::reference

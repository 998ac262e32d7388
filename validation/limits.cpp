#include "validation/limits.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace skitter::validation {
namespace {

constexpr double largestAngle = 3.1;  // of any limit

// The angle from rest, and what the ellipse allows in that direction.
double beyondEllipse(const judged::Ellipse& ellipse, const glm::dvec3& d) {
  const double sine = std::hypot(d.x, d.y);
  const double hx = sine > 0 ? d.x / sine : 1, hy = sine > 0 ? d.y / sine : 0;
  const double ax = hx >= 0 ? ellipse.px : ellipse.nx, ay = hy >= 0 ? ellipse.py : ellipse.ny;
  const double allowed = 1 / std::hypot(hx / std::min(ax, largestAngle), hy / std::min(ay, largestAngle));
  return std::max(0.0, std::atan2(sine, d.z) - allowed);
}

struct Beyond {
  const glm::dvec3 &d, &rest;

  double operator()(const judged::Free&) const { return 0; }
  double operator()(const judged::Cone& cone) const {
    return std::max(0.0, std::atan2(std::hypot(d.x, d.y), d.z) - std::min(cone.halfAngle, largestAngle));
  }
  double operator()(const judged::Ellipse& ellipse) const { return beyondEllipse(ellipse, d); }
  // A hinged bone stays as steep to its axis as it is at rest, and its turn within the range.
  double operator()(const judged::Hinge& hinge) const {
    const auto steepness = [](const glm::dvec3& v) { return std::atan2(v.x, std::hypot(v.y, v.z)); };
    return std::max(std::abs(steepness(d) - steepness(rest)),
                    judged::outside(std::atan2(-d.y, d.z), hinge.min, hinge.max));
  }
};

struct Judged {
  judged::Limit operator()(const ik::Free&) const { return judged::Free{}; }
  judged::Limit operator()(const ik::Cone& cone) const { return judged::Cone{cone.halfAngle}; }
  judged::Limit operator()(const ik::Ellipse& e) const { return judged::Ellipse{e.px, e.py, e.nx, e.ny}; }
  judged::Limit operator()(const ik::Hinge& h) const { return judged::Hinge{h.axis, h.min, h.max}; }
};

struct Reference {
  reference::Limit operator()(const ik::Free&) const { return reference::freeLimit(); }
  reference::Limit operator()(const ik::Cone& cone) const { return reference::coneLimit(cone.halfAngle); }
  reference::Limit operator()(const ik::Ellipse& e) const {
    return reference::ellipseLimit(e.px, e.py, e.nx, e.ny);
  }
  reference::Limit operator()(const ik::Hinge& h) const { return reference::hingeLimit(h.min, h.max); }
};

}  // namespace

double judged::outside(double angle, double low, double high) {
  if (angle >= low && angle <= high) return 0;
  const auto around = [](double difference) {
    return std::abs(std::remainder(difference, 2 * std::numbers::pi));
  };
  return std::min(around(angle - low), around(angle - high));
}

double judged::beyond(const Limit& limit, const glm::dvec3& d, const glm::dvec3& rest) {
  return std::visit(Beyond{d, rest}, limit);
}

judged::Limit judgedLimit(const ik::Limit& limit) { return std::visit(Judged{}, limit); }
reference::Limit referenceLimit(const ik::Limit& limit) { return std::visit(Reference{}, limit); }

}  // namespace skitter::validation

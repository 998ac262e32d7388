#pragma once

#include <glm/glm.hpp>
#include <limits>

// How far a bone may turn from rest (docs/ik.md, Limits), in the form in which poses are kept: the swing as
// (X, Y) = (d.x, d.y) / (1 + d.z) of its direction d in its frame, so that |(X, Y)| = tan(angle / 2), and
// the twist as tan(tau / 2).
namespace skitter::reference {

enum class LimitKind { free, cone, ellipse, hinge };

// Radians. Stereographic coordinates are singular at pi.
inline constexpr double widestAngle = 3.1;
// tan(theta / 2) of a free ball, which crosses the point opposite to its rest direction.
inline constexpr double widestFree = 1e4;

struct Limit {
  LimitKind kind = LimitKind::cone;
  double tanHalfCone = 0;                  // of free and cone: tan(alpha / 2)
  glm::dvec4 ellipse{0};                   // half-angles toward +x, +y, -x, -y of the frame, radians
  double tanHalfLow = 0, tanHalfHigh = 0;  // of hinge: tan(q / 2)
  double tanHalfTwistLow = 0, tanHalfTwistHigh = 0;  // of all but hinges

  // Whether the twist can change.
  bool twists() const { return kind != LimitKind::hinge && tanHalfTwistLow < tanHalfTwistHigh; }
};

// Angles are radians; those beyond `widestAngle` are it. std::invalid_argument where a half-angle is not
// above 0, low is above high, or an angle is not finite.
Limit freeLimit();
Limit coneLimit(double halfAngle);
Limit ellipseLimit(double positiveX, double positiveY, double negativeX, double negativeY);
Limit hingeLimit(double low, double high);
Limit withTwist(Limit limit, double low, double high);

// The nearest legal swing along the same way from rest, and the nearest legal twist.
glm::dvec2 clampSwing(const Limit& limit, const glm::dvec2& xy);
double clampTwist(const Limit& limit, double tanHalfTwist);

// The greatest angle from rest that a ball's limit allows anywhere.
double greatestAngle(const Limit& limit);

// How far a bone may still turn: the tangents of the angles left, as a step of x turns by atan(x). Infinite
// where the limit is too far to matter.
struct Room {
  double low = -std::numeric_limits<double>::infinity(), high = -low;
  glm::dvec2 way{1, 0};  // of a ball: which way, as shares of away from rest and around it
};
// d: where the bone points; s: the sine of its angle from rest; h: the way in which it is turned, a unit
// vector.
Room swingRoom(const Limit& limit, const glm::dvec3& d, double s, const glm::dvec2& h);
Room twistRoom(const Limit& limit, double tanHalfTwist);

}  // namespace skitter::reference

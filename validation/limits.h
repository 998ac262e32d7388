#pragma once

#include <glm/glm.hpp>
#include <variant>

#include "cpu_reference/limit.h"
#include "skitter/ik.h"

// The kinds of limits (docs/ik.md) as the judge of poses knows them: in double, in radians, and sharing no
// code with those who solve. And what they are for the reference.
namespace skitter::validation {

namespace judged {

struct Free {};
struct Cone {
  double halfAngle;
};
struct Ellipse {
  double px, py, nx, ny;
};
struct Hinge {
  glm::dvec3 axis;  // at rest, any length but 0
  double min, max;
};
using Limit = std::variant<Free, Cone, Ellipse, Hinge>;

// How far a bone is beyond its limit where it points to `d`; `rest` is where it points at rest. Both in the
// frame that the bones before it carry.
double beyond(const Limit& limit, const glm::dvec3& d, const glm::dvec3& rest);
// How far `angle` is from a range, on the circle: 190 degrees are 10 beyond 180, not 370 before it.
double outside(double angle, double low, double high);

}  // namespace judged

judged::Limit judgedLimit(const ik::Limit& limit);
reference::Limit referenceLimit(const ik::Limit& limit);

}  // namespace skitter::validation

#pragma once

#include <glm/glm.hpp>

namespace skitter::reference {

// S(d): the shortest rotation of Z onto a unit vector.
glm::dmat3 shortestFromZ(const glm::dvec3& d);
// The shortest rotation of unit a onto unit b; where they are opposite, half a turn about an axis across a.
// Nothing where either is 0.
glm::dmat3 shortest(const glm::dvec3& a, const glm::dvec3& b);
// Q(omega): the rotation of the quaternion normalize(omega / 2, 1), which is about |omega| radians.
glm::dmat3 turnBy(const glm::dvec3& omega);
// `wish` made perpendicular to the unit `line` and unit; where less than 1e-6 is left of it, some other
// perpendicular.
glm::dvec3 perpendicular(const glm::dvec3& wish, const glm::dvec3& line);

}  // namespace skitter::reference

#pragma once

#include <glm/glm.hpp>

#include "skitter/error.h"
#include "skitter/ik.h"

// What the host does with the kinds of limits: it checks them, writes them into records and keeps to them.
// Radians; directions are in the bone's frame, where rest is (0, 0, 1).
namespace skitter::ik {

inline constexpr double widestAngle = 3.1;

// Finite, and longer than 0.
bool hasDirection(const glm::vec3& v);
// An Error(input) that names the bone, counted from 0.
Error faultOf(size_t bone, const std::string& fault);
// Refuses lists of another length than a batch needs.
void expectCount(const char* name, size_t found, size_t expected);
// Refuses a limit or a twist range that cannot be, by faultOf.
void checkLimits(size_t number, const Bone& bone);

// LIMIT_CONE, LIMIT_ELLIPSE or LIMIT_HINGE; 0: free.
int kindOf(const Limit& limit);
// Vec4 [3] of the bone's record, in which kinds keep numbers of their own; `along` is the bone in its frame.
glm::dvec4 numbersOf(const Limit& limit, const glm::dvec3& along);

// The direction at polar angle `theta` from rest, leaning toward `phi`.
glm::dvec3 leaning(double theta, double phi);
// The greatest polar angle that a ball's limit allows toward `phi`.
double greatestAngle(const Limit& limit, double phi);
// The nearest legal direction the same way from rest.
glm::dvec3 clamped(const Limit& limit, const glm::dvec3& direction);

}  // namespace skitter::ik

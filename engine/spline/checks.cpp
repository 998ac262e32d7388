#include "spline/checks.h"

#include <fmt/format.h>

#include <cmath>

#include "shared/spline_batch.h"
#include "skitter/error.h"

namespace skitter {
namespace {

// NaN is not within.
bool within(const glm::vec3& v, float bound) {
  return std::abs(v.x) <= bound && std::abs(v.y) <= bound && std::abs(v.z) <= bound;
}

void checkVectors(const std::string& what, const char* name, std::span<const glm::vec3> list, float bound) {
  for (size_t k = 0; k < list.size(); ++k)
    if (const glm::vec3& v = list[k]; !within(v, bound))
      throw inputError(fmt::format("{}: {} {} is ({}, {}, {}), expected numbers within +-{}", what, name, k,
                                   v.x, v.y, v.z, bound));
}

void checkShare(const char* name, float value, float low) {
  if (!(value >= low && value <= 1))
    throw inputError(fmt::format("the spline's {} is {}, expected {} to 1", name, value, low));
}

}  // namespace

void checkTangentRule(const SplineTangents& tangents) {
  if (tangents.rule == SplineRule::cardinal) checkShare("tension", tangents.tension, 0);
  if (tangents.rule != SplineRule::kochanekBartels) return;
  checkShare("tension", tangents.tension, -1);
  checkShare("continuity", tangents.continuity, -1);
  checkShare("bias", tangents.bias, -1);
}

void checkPointCount(size_t points) {
  if (points < 2 || points > kMostSplinePoints)
    throw inputError(fmt::format("a spline of {} points, expected 2 to {}", points, kMostSplinePoints));
}

void checkPoints(const std::string& what, std::span<const glm::vec3> points) {
  checkVectors(what, "point", points, shared::LARGEST_COORDINATE);
}

void checkTangents(const std::string& what, std::span<const glm::vec3> tangents) {
  checkVectors(what, "the tangent of point", tangents, shared::LARGEST_TANGENT);
}

void checkKnots(const std::string& what, std::span<const float> knots) {
  for (size_t k = 0; k < knots.size(); ++k) {
    if (!(std::abs(knots[k]) <= shared::LARGEST_COORDINATE))
      throw inputError(fmt::format("{}: knot {} is {}, expected a number within +-{}", what, k, knots[k],
                                   shared::LARGEST_COORDINATE));
    if (k > 0 && !(knots[k] - knots[k - 1] >= shared::LEAST_STEP))
      throw inputError(
          fmt::format("{}: knot {} is {} after {}, expected each at least {} after the one before", what, k,
                      knots[k], knots[k - 1], shared::LEAST_STEP));
  }
}

void checkClock(const std::string& what, const SplineClock& clock) {
  if (!std::isfinite(clock.start) || std::abs(clock.start) > 1e30)
    throw inputError(fmt::format("{}: its clock starts at {}, expected a number", what, clock.start));
  // What is held in float32 must still be more than 0.
  if (!(clock.duration >= 1e-30 && clock.duration <= 1e30))
    throw inputError(fmt::format("{}: its duration is {}, expected more than 0", what, clock.duration));
}

}  // namespace skitter

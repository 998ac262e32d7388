#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>

#include "skitter/spline.h"

namespace skitter {

// Each throws Error(input) that begins with `what`: "the spline", "spline 7".
void checkTangentRule(const SplineTangents&);
void checkPoints(const std::string& what, std::span<const glm::vec3>);
void checkKnots(const std::string& what, std::span<const float>);
void checkTangents(const std::string& what, std::span<const glm::vec3>);
void checkClock(const std::string& what, const SplineClock&);

inline constexpr uint32_t kMostSplinePoints = 1024;
void checkPointCount(size_t points);

}  // namespace skitter

#pragma once

#include "cpu_reference/types.h"

namespace skitter::reference {

// A foot's way through a step, relative to the step's tile, and dP/ds over the segment's own parameter.
struct SplinePoint {
  glm::dvec3 position{0}, tangent{0};
};
SplinePoint splineAt(const Step& step, double u);

// Progress along the spline for progress in time, eased, and its rate.
struct Eased {
  double progress = 0, rate = 0;
};
Eased eased(const Step& step, double u);

// `tick` is n.
Foot swing(const Step& step, const AgentBody& body, double tick);

}  // namespace skitter::reference

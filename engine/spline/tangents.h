#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "skitter/spline.h"

namespace skitter {

struct TangentPair {
  glm::dvec3 arriving, leaving;
};

// Tangents of every key of a chain that was checked, by its rule (docs/spline.md, Tangents). `points` and
// `knots` are the keys': of a closed chain the first point again at the end.
std::vector<TangentPair> tangentsOf(const SplineChain&, const std::vector<glm::dvec3>& points,
                                    const std::vector<double>& knots);

}  // namespace skitter

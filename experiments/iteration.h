#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "experiments/page/table.h"

namespace skitter::experiments {

// Figure 1: one iteration of FABRIK on a chain of four bones, as the reference computes it. Lengths are
// shares of the reach, the base is at 0, all lies in the plane z = 0.
struct FabrikIteration {
  glm::dvec3 target{0};
  std::vector<glm::dvec3> before, backward, forward;  // joints: at first, tip to base, base to tip

  double errorBefore() const { return glm::distance(before.back(), target); }
  double errorAfter() const { return glm::distance(forward.back(), target); }
  Table table() const;
};

FabrikIteration measureIteration();

}  // namespace skitter::experiments

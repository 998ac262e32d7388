#pragma once

#include <optional>

#include "cpu_reference/types.h"

namespace skitter::reference {

struct Footfall {
  glm::dvec3 place{0};  // world, metres
  double speed = 0;     // m/s
};

// A foot and its tip, relative to the body, at the end of a tick.
struct FootAt {
  const AgentBody& body;
  double progress;  // 1: planted
  glm::dvec3 tip;
};

// If the foot came down in the tick of `dt` seconds that led from `before` to `after`.
std::optional<Footfall> footfall(const FootAt& before, const FootAt& after, double dt);

}  // namespace skitter::reference

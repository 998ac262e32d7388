#pragma once

#include <array>
#include <optional>

#include "cpu_reference/types.h"

namespace skitter::reference {

// One of the ways that a step may take over what lies between its ends.
struct Way {
  int side = 0;                        // lanes to the left of the straight one; negative: to the right
  double height = 0;                   // of the lift that clears the ground at all of its places, uncapped
  double heightError = 0;              // of `height` for each metre by which the ground's height errs
  double cost = 0;                     // metres squared
  glm::dvec3 lift{0};                  // b
  std::array<double, 7> gaps{};        // ground above the way without its lift's height, metres
  std::array<glm::dvec2, 7> places{};  // x, z relative
};

struct Route {
  std::array<Way, 5> ways;  // in the order in which ties are decided
  int chosen = 0;
  const Way& way() const { return ways[static_cast<size_t>(chosen)]; }
};

// From `liftOff` to `landing`, relative. `startTangent` is that of a step aimed anew; a leg that lifts starts
// along its lift. `share` of the step height is the least lift.
Route route(const Tuning& tuning, const Heights& heights, const AgentBody& body, const glm::dvec3& liftOff,
            const glm::dvec3& landing, const std::optional<glm::dvec3>& startTangent, double share);

}  // namespace skitter::reference

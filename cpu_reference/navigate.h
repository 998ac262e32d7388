#pragma once

#include "cpu_reference/types.h"

namespace skitter::reference {

struct NavigateResult {
  Goal goal;
  glm::dvec2 desired{0};  // velocity x, z
  // Distances to the decisions, metres; infinite where a decision was not asked for.
  double arrivalMargin = 0;
  glm::dvec2 edgeMargin{0};
};

// A decision that the caller takes instead of the rule, to recompute the other side of a tie.
struct NavigateChoices {
  int arrived = -1;                  // 0 or 1: forced
  glm::ivec2 turnedBack = {-1, -1};  // per axis, 0 or 1: forced
};

NavigateResult navigate(const Tuning& tuning, const AgentBody& body, const Goal& goal,
                        const NavigateChoices& choices = {});

}  // namespace skitter::reference

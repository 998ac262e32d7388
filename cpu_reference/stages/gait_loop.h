#pragma once

#include <optional>

#include "cpu_reference/types.h"

namespace skitter::reference {

struct LoopGaitResult {
  Gait gait;
  double durationMargin = 0;  // ticks, of the rounding of D
};

// The phase of feet on fixed loops. `phase` is the last tick's, `body` the new one; `duration`, if any, is D
// instead of the rule's; `slowest` is Creature::slowest.
LoopGaitResult loopGait(const Tuning& tuning, int groups, const AgentBody& body, double phase,
                        const std::optional<double>& duration = {}, double slowest = 1);

}  // namespace skitter::reference

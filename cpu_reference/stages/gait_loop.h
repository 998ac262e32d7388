#pragma once

#include <optional>

#include "cpu_reference/types.h"

namespace skitter::reference {

struct LoopGaitResult {
  Gait gait;
  double durationMargin = 0;  // ticks, of the rounding of D
};

// The phase of feet on fixed loops. `phase` is the last tick's, `body` the new one; `duration`, if any, is D
// instead of the rule's.
LoopGaitResult loopGait(const Tuning& tuning, int groups, const AgentBody& body, double phase,
                        const std::optional<double>& duration = {});

}  // namespace skitter::reference

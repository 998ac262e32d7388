#pragma once

#include "cpu_reference/types.h"

namespace skitter::reference {

struct LoopFoot {
  Foot foot;
  double theta = 0, flown = 0;  // shares of the cycle and of the swing; flown < 0: it stands
};

// Where a foot is on its loop: straight back while it stands, then forward on a spline.
LoopFoot loopSwing(const Tuning& tuning, int groups, const Limb& limb, const AgentBody& body,
                   const Gait& gait);

}  // namespace skitter::reference

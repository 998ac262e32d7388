#pragma once

#include "cpu_reference/types.h"

namespace skitter::reference {

Metric measure(const Heights& heights, const Limb& limb, const AgentBody& body, const Step& step,
               const Foot& foot, const Chain& chain, const Metric& previous);

}  // namespace skitter::reference

#pragma once

#include "cpu_reference/clips/table.h"
#include "cpu_reference/stages/ik_planted.h"
#include "cpu_reference/types.h"

namespace skitter::reference {

// From the clips' skin to world axes about the body's position, of one joint of the palette.
Affine clipPose(const ClipTable& table, const AgentBody& body, const Play& play, size_t joint);
// `fix` is that of the joint's bone; none for joints of no leg.
Affine plantedPose(const ClipTable& table, const AgentBody& body, const Play& play, size_t joint,
                   const BoneFix& fix);

}  // namespace skitter::reference

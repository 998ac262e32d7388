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

// A joint of any of a leg's lost bones: all of its skin goes to the stump's end, which is where `bone`, the
// first of them, starts. `fix` is that bone's.
Affine stumpPose(const ClipTable& table, const AgentBody& body, const Play& play, size_t leg, size_t bone,
                 const BoneFix& fix);

}  // namespace skitter::reference

#pragma once

#include "cpu_reference/clips/table.h"
#include "cpu_reference/types.h"

// Clips made of numbers.
namespace skitter::test {

// idle (2 s), walk (1 m/s, 1 s), run (2 m/s, 0.5 s), each of a palette of one joint that does not move;
// frames at the ends, of walk also at 0.25 s and twice at 0.5 s, where it jumps.
reference::ClipTable threeGaits();

// One clip of the creature with one frame, in which every joint is at rest: entry leg * (bones + 1) + i of
// the palette is joint i of the leg.
reference::ClipTable restClip(const reference::Creature& creature);

}  // namespace skitter::test

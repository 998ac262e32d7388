#pragma once

#include "bench/cpu_baseline/batch.h"

namespace skitter::baseline {

// Targets of `chains` chains. Free chains: any direction, 0.2 to 0.95 of the length away. Limited ones: the
// tips of random legal poses, so that each can be reached.
Rows coldTargets(const Chain& chain, size_t chains, uint32_t seed);

// `ticks` sets of targets, each 2 % of the length from the one before: of free chains in a direction of its
// own each tick, within 0.2 to 0.95; of limited ones the tips of legal poses that drift toward others.
std::vector<Rows> trackedTargets(const Chain& chain, size_t chains, int ticks, uint32_t seed);

}  // namespace skitter::baseline

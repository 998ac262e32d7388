#pragma once

#include "bench/cpu_baseline/refill.h"

namespace skitter::baseline {

// One kernel for one kind of lanes; a file each, for they are large.
using SolveRange = void(const Model& model, const Options& options, Batch& batch, Range range);
SolveRange scalarFree, scalarLimitedFabrik, scalarActiveSet;
SolveRange simdFree, simdLimitedFabrik, simdActiveSet;

}  // namespace skitter::baseline

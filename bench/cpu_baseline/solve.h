#pragma once

#include "bench/cpu_baseline/refill.h"

namespace skitter::baseline {

void solveScalarRange(const Model& model, const Options& options, Batch& batch, Range range);
void solveSimdRange(const Model& model, const Options& options, Batch& batch, Range range);

}  // namespace skitter::baseline

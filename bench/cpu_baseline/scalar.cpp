#include "bench/cpu_baseline/dispatch.h"
#include "bench/cpu_baseline/solve.h"

namespace skitter::baseline {

void solveScalarRange(const Model& model, const Options& options, Batch& batch, Range range) {
  solveFree<float>(model, options, batch, range);
}

}  // namespace skitter::baseline

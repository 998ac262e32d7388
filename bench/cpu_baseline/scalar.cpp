#include "bench/cpu_baseline/dispatch.h"
#include "bench/cpu_baseline/solve.h"

namespace skitter::baseline {

void scalarFree(const Model& model, const Options& options, Batch& batch, Range range) {
  solveFree<float>(model, options, batch, range);
}

void scalarLimitedFabrik(const Model& model, const Options& options, Batch& batch, Range range) {
  solveLimitedFabrik<float>(model, options, batch, range);
}

void scalarActiveSet(const Model& model, const Options& options, Batch& batch, Range range) {
  solveActiveSet<float>(model, options, batch, range);
}

}  // namespace skitter::baseline

#include "bench/cpu_baseline/dispatch.h"
#include "bench/cpu_baseline/solve.h"

namespace skitter::baseline {

void simdActiveSet(const Model& model, const Options& options, Batch& batch, Range range) {
  solveActiveSet<Lanes>(model, options, batch, range);
}

}  // namespace skitter::baseline

#include "bench/cpu_baseline/dispatch.h"
#include "bench/cpu_baseline/solve.h"

namespace skitter::baseline {

void simdLimitedFabrik(const Model& model, const Options& options, Batch& batch, Range range) {
  solveLimitedFabrik<Pair<Lanes>>(model, options, batch, range);
}

}  // namespace skitter::baseline

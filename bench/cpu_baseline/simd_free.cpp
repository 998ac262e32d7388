#include "bench/cpu_baseline/dispatch.h"
#include "bench/cpu_baseline/solve.h"

namespace skitter::baseline {

// A pass of FABRIK is one long chain of dependent operations: four registers of chains side by side keep the
// units busy (measured: one 19, two 35, four 50 million solves a core-second, 8 floats a register).
void simdFree(const Model& model, const Options& options, Batch& batch, Range range) {
  solveFree<Pair<Pair<Lanes>>>(model, options, batch, range);
}

}  // namespace skitter::baseline

#include "bench/cpu_baseline/dispatch.h"
#include "bench/cpu_baseline/solve.h"

namespace skitter::baseline {

// A pass of FABRIK is one long chain of dependent operations: four registers of chains side by side keep the
// units busy (measured, 5 joints, 8 floats a register: one 19, two 35, four 50 million solves a core-second).
// Stretch-align's sums depend on each other less, and its chains wait for the last of those that they started
// with: two.
void simdFree(const Model& model, const Options& options, Batch& batch, Range range) {
  if (options.solver == Solver::stretchAlign) return solveFree<Pair<Lanes>>(model, options, batch, range);
  solveFree<Pair<Pair<Lanes>>>(model, options, batch, range);
}

}  // namespace skitter::baseline

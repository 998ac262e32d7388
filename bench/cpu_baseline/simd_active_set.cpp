#include "bench/cpu_baseline/dispatch.h"
#include "bench/cpu_baseline/solve.h"

namespace skitter::baseline {

// A step has independent work enough (a bone's columns do not wait for another's): one register of chains;
// with two the working set of ten joints is too much for the nearest cache.
void simdActiveSet(const Model& model, const Options& options, Batch& batch, Range range) {
  solveActiveSet<Lanes>(model, options, batch, range);
}

}  // namespace skitter::baseline

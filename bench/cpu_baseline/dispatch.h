#pragma once

#include "bench/cpu_baseline/active_set.h"
#include "bench/cpu_baseline/free_chain.h"
#include "bench/cpu_baseline/limited_fabrik.h"

namespace skitter::baseline {

template <class Kernel>
void solveWith(const Model& model, const Options& options, Batch& batch, Range range) {
  Kernel kernel(model, options, batch);
  solveRange(kernel, range);
}

// Calls solve.operator()<N>() with the number of bones compiled in where it is one that is measured, else 0.
template <class Solve>
void withBones(int bones, const Solve& solve) {
  switch (bones) {
    case 1:
      return solve.template operator()<1>();
    case 2:
      return solve.template operator()<2>();
    case 4:
      return solve.template operator()<4>();
    case 9:
      return solve.template operator()<9>();
    case 15:
      return solve.template operator()<15>();
    default:
      return solve.template operator()<0>();
  }
}

template <class F>
void solveFree(const Model& model, const Options& options, Batch& batch, Range range) {
  withBones(model.bones, [&]<int N>() { solveWith<FreeChain<F, N>>(model, options, batch, range); });
}

template <class F>
void solveLimitedFabrik(const Model& model, const Options& options, Batch& batch, Range range) {
  withBones(model.bones, [&]<int N>() { solveWith<LimitedFabrik<F, N>>(model, options, batch, range); });
}

template <class F>
void solveActiveSet(const Model& model, const Options& options, Batch& batch, Range range) {
  withBones(model.bones, [&]<int N>() { solveWith<ActiveSet<F, N>>(model, options, batch, range); });
}

}  // namespace skitter::baseline

#include "bench/cpu_baseline/batch.h"

#include <stdexcept>
#include <thread>

#include "bench/cpu_baseline/solve.h"

namespace skitter::baseline {
namespace {

void skipAll(Batch& batch) {
  for (size_t chain = 0; chain < batch.chains; ++chain) batch.outcome.at(2, chain) = float(Stop::skipped);
}

SolveRange* chosen(const Model& model, const Options& options, bool simd) {
  const bool activeSet = options.solver == Solver::activeSet;
  if (!model.limited && !activeSet) return simd ? simdFree : scalarFree;
  if (model.limited && activeSet) return simd ? simdActiveSet : scalarActiveSet;
  if (model.limited && options.solver == Solver::fabrik)
    return simd ? simdLimitedFabrik : scalarLimitedFabrik;
  throw std::invalid_argument("stretch-align is for free chains, the active set for limited ones");
}

// The share of thread `i` of `threads`, in whole groups of chains.
Range shareOf(size_t chains, int i, int threads) {
  const size_t groups = (chains + Rows::kGroup - 1) / Rows::kGroup;
  const auto edge = [&](int k) { return std::min(groups * k / threads * Rows::kGroup, chains); };
  return {edge(i), edge(i + 1)};
}

}  // namespace

Batch::Batch(const Model& model, size_t count)
    : chains(count),
      target(3, count),
      joints(3 * model.bones, count),
      pose(model.limited ? 3 * model.bones : 0, count),
      outcome(3, count),
      patience(model.limited ? 2 : 0, count) {}

void solveScalar(const Model& model, const Options& options, Batch& batch) {
  if (model.bones == 0) return skipAll(batch);
  chosen(model, options, false)(model, options, batch, {0, batch.chains});
}

void solveSimd(const Model& model, const Options& options, Batch& batch, int threads) {
  if (model.bones == 0) return skipAll(batch);
  SolveRange* const solve = chosen(model, options, true);
  std::vector<std::thread> others;
  for (int i = 1; i < threads; ++i) {
    others.emplace_back([&, i] { solve(model, options, batch, shareOf(batch.chains, i, threads)); });
  }
  solve(model, options, batch, shareOf(batch.chains, 0, threads));
  for (std::thread& other : others) other.join();
}

std::string buildDescription() {
  return std::string(SKITTER_BENCH_FLAGS) + ", " + SKITTER_BENCH_COMPILER + ", " + std::to_string(kLanes) +
         " floats a register";
}

}  // namespace skitter::baseline

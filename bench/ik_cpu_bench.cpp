// Solves per core-second of the CPU opponent (items_per_second: over the threads' CPU time, so that other
// programs on the machine count for little; median and best of the repetitions). Every case's results are
// verified before it is timed.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <numbers>

#include "bench/cpu_baseline/verify.h"
#include "bench/cpu_baseline/workload.h"

namespace {

using namespace skitter::baseline;

constexpr size_t kChains = 16384;  // the least memory that keeps the start and the end of a batch cheap
constexpr int kTicks = 24;

struct Case {
  const char* name;
  Solver solver;
  Limit limit;
};

Limit cone60() {
  Limit limit;
  limit.kind = LimitKind::cone;
  limit.cone = float(std::numbers::pi / 3);
  return limit;
}

Limit hinge() {
  Limit limit;
  limit.kind = LimitKind::hinge;
  limit.axis = {0, 0, 1};
  limit.low = -1.2f, limit.high = 1.2f;
  return limit;
}

void solve(bool simd, const Model& model, const Options& options, Batch& batch) {
  simd ? solveSimd(model, options, batch) : solveScalar(model, options, batch);
}

// False, and the case is reported as failed, if the results do not hold.
bool holds(benchmark::State& state, const Chain& chain, const Options& options, const Batch& batch) {
  const Findings found = verify(chain, options, batch);
  state.counters["reached"] = double(found.reached) / double(batch.chains);
  state.counters["iterations"] = found.iterations;
  if (!found.hold()) state.SkipWithError(("the results do not hold: " + describe(found)).c_str());
  return found.hold();
}

// What a case is run on, made once for all of its repetitions.
struct Workload {
  Chain chain;
  Model model;
  Rows cold;
  std::vector<Rows> ticks;

  Workload(int joints, const Limit& limit)
      : chain(bentChain(joints - 1, limit)),
        model(chain),
        cold(coldTargets(chain, kChains, 1)),
        ticks(trackedTargets(chain, kChains, kTicks, 2)) {}
};

Workload& workload(int joints, const Limit& limit) {
  static std::map<std::pair<int, LimitKind>, std::unique_ptr<Workload>> made;
  std::unique_ptr<Workload>& one = made[{joints, limit.kind}];
  if (!one) one = std::make_unique<Workload>(joints, limit);
  return *one;
}

void cold(benchmark::State& state, const Case& of, int joints, bool simd) {
  const Workload& work = workload(joints, of.limit);
  Batch batch(work.model, kChains);
  batch.target = work.cold;
  const Options options{of.solver};
  solve(simd, work.model, options, batch);
  if (!holds(state, work.chain, options, batch)) return;
  for (auto _ : state) solve(simd, work.model, options, batch);
  state.SetItemsProcessed(int64_t(state.iterations() * kChains));
}

// Over the ticks and back again, so that every move is one of 2 %.
void tracking(benchmark::State& state, const Case& of, int joints, bool simd) {
  Workload& work = workload(joints, of.limit);
  Batch batch(work.model, kChains);
  Options options{of.solver};
  batch.target = work.ticks[0];
  solve(simd, work.model, options, batch);
  options.start = Start::previous;
  int tick = 0, step = 1;
  const auto advance = [&] {
    if (tick + step < 0 || tick + step >= kTicks) step = -step;
    tick += step;
    std::swap(batch.target, work.ticks[tick]);
    solve(simd, work.model, options, batch);
    std::swap(batch.target, work.ticks[tick]);
  };
  for (int i = 0; i < kTicks; ++i) advance();
  batch.target = work.ticks[tick];
  if (!holds(state, work.chain, options, batch)) return;
  for (auto _ : state) advance();
  state.SetItemsProcessed(int64_t(state.iterations() * kChains));
}

double most(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

void registerCases() {
  const Case cases[] = {{"fabrik/none", Solver::fabrik, {}},
                        {"stretch-align/none", Solver::stretchAlign, {}},
                        {"fabrik/cone60", Solver::fabrik, cone60()},
                        {"fabrik/hinge", Solver::fabrik, hinge()},
                        {"active-set/cone60", Solver::activeSet, cone60()},
                        {"active-set/hinge", Solver::activeSet, hinge()}};
  for (const Case& of : cases) {
    for (int joints : {5, 10}) {
      for (bool simd : {false, true}) {
        const std::string name =
            std::string(of.name) + "/J" + std::to_string(joints) + (simd ? "/simd" : "/scalar");
        for (auto* run : {cold, tracking}) {
          benchmark::RegisterBenchmark((name + (run == cold ? "/cold" : "/tracking")).c_str(),
                                       [=](benchmark::State& state) { run(state, of, joints, simd); })
              ->Unit(benchmark::kMicrosecond)
              ->MinTime(0.1)
              ->Repetitions(9)
              ->ComputeStatistics("max", most)
              ->ReportAggregatesOnly();
        }
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
#if defined(SKITTER_DEBUG_BUILD)
  std::fprintf(stderr,
               "ik_cpu_bench: this is a debug build; configure with CMAKE_BUILD_TYPE=RelWithDebInfo\n");
  return 2;
#endif
  benchmark::AddCustomContext("cpu opponent", buildDescription());
  registerCases();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}

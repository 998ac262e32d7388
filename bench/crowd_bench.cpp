// Each stage of a crowd's tick by itself, on the device and on the CPU: CONTROLLER/STAGE/CONTESTANT/AGENTS.
// An iteration is a whole tick; its time is the stage's share of the tick's CPU time, or of the wall clock's
// for a device that is no CPU. A tick of each is checked against the reference before anything is timed.
// --agents=N takes N of them, not 10,000. scripts/compare-builds holds two builds against each other with it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <memory>

#include "base/clock.h"
#include "bench/crowd/contest.h"
#include "bench/ik/machine.h"
#include "crowd/stage.h"
#include "skitter/error.h"

namespace {

using namespace skitter;

constexpr float kDt = 1.0f / 60;
constexpr int kWarmUp = 60, kTicks = 40;
constexpr int64_t kAgents = 10000;

enum class Who { device, simd, scalar };
constexpr const char* whoNames[] = {"device", "cpu-simd", "cpu-scalar"};

Device& device() {
  static Device made = [] {
    DeviceRequest request;
    if (const char* wanted = std::getenv("SKITTER_BENCH_DEVICE")) request.device = wanted;
    return Device::create(request);
  }();
  return made;
}

// A crowd that has walked for a second, and one who animates it further.
struct Run {
  std::string key;
  std::unique_ptr<Crowd> crowd;
  std::unique_ptr<bench::Contestant> contestant;
  std::string fault;  // empty if its tick agrees with the reference
};

CrowdOptions options(bool fuse) {
  CrowdOptions made;
  made.fuse = fuse;
  made.measure = false;
  made.timestamps = true;
  return made;
}

Run makeRun(const std::string& key, Controller controller, Who who, uint32_t agents, bool fuse) {
  Scene scene = builtinScene();
  scene.herds.front().controller = controller;
  scene.herds.front().agents = agents;
  Run run{key, std::make_unique<Crowd>(device(), scene.loadTerrain(), scene, options(fuse)), nullptr, {}};
  const auto walk = bench::deviceContestant(device(), *run.crowd, kDt);
  for (int i = 0; i < kWarmUp; ++i) walk->tick();
  const uint64_t next = run.crowd->tick() + 1;
  run.contestant = who == Who::device ? bench::deviceContestant(device(), *run.crowd, kDt)
                                      : bench::cpuContestant(*run.crowd, who == Who::scalar, 1, true);
  run.contestant->timeStages(true);
  for (const validation::StageResult& check : bench::checkTick(
           *run.crowd, *run.contestant, next, bench::demandOf(*run.crowd, options(fuse)), scene.seed))
    if (!check.pass) run.fault += check.name + ": " + check.why + "; ";
  return run;
}

// The last one is kept: the stages of a tick are timed one after the other.
Run& runOf(Controller controller, Who who, uint32_t agents, bool fuse) {
  static Run run;
  const std::string key =
      nameOf(controller) + std::string(whoNames[int(who)]) + std::to_string(agents) + (fuse ? "" : " apart");
  if (run.key != key) {
    run = {};
    run = makeRun(key, controller, who, agents, fuse);
  }
  return run;
}

double millisecondsOf(const std::vector<StageTime>& times, const std::string& stage) {
  double sum = 0;
  for (const StageTime& time : times)
    if (stage.empty() || crowd::makes(stage, time.stage)) sum += time.milliseconds;
  return sum;
}

void timeStage(benchmark::State& state, Controller controller, const std::string& stage, Who who, bool fuse) {
  const auto agents = static_cast<uint32_t>(state.range(0));
  Run& run = runOf(controller, who, agents, fuse);
  if (!run.fault.empty()) {
    state.SkipWithError(("differs from the reference: " + run.fault).c_str());
    return;
  }
  const bool cpu = who != Who::device || bench::isCpu(device().report());
  double seconds = 0;
  for (auto _ : state) {
    const std::vector<StageTime> before = run.contestant->stageTimes();
    const base::Seconds spent = base::timed([&] { run.contestant->tick(); });
    const std::vector<StageTime> after = run.contestant->stageTimes();
    const double whole = millisecondsOf(after, "") - millisecondsOf(before, "");
    const double mine = millisecondsOf(after, stage) - millisecondsOf(before, stage);
    const double each = (cpu ? spent.cpu : 1e-3 * whole) * mine / std::max(whole, 1e-12);
    state.SetIterationTime(each);
    seconds += each;
  }
  state.counters["an_agent_ns"] = 1e9 * seconds / (static_cast<double>(state.iterations()) * agents);
}

void add(Controller controller, const std::string& stage, Who who, bool fuse, int64_t agents) {
  benchmark::RegisterBenchmark(
      (std::string(nameOf(controller)) + "/" + stage + "/" + whoNames[int(who)]).c_str(),
      [=](benchmark::State& state) { timeStage(state, controller, stage, who, fuse); })
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond)
      ->Iterations(kTicks)
      ->Arg(agents);
}

void addAll(int64_t agents) {
  for (const Controller controller : {Controller::adaptive, Controller::clip})
    for (const Who who : {Who::device, Who::simd, Who::scalar}) {
      const auto stagesOf = [&](bool fuse) { return crowd::stagesOf(controller, options(fuse)); };
      const std::vector<crowd::Stage> fused = stagesOf(true);
      for (const crowd::Stage& stage : fused) add(controller, stage.makes.name(), who, true, agents);
      // Those that are made at once, one by one.
      for (const crowd::Stage& stage : stagesOf(false))
        if (std::none_of(fused.begin(), fused.end(),
                         [&](const crowd::Stage& f) { return f.makes == stage.makes; }))
          add(controller, stage.makes.name(), who, false, agents);
    }
}

}  // namespace

int main(int argc, char** argv) {
#if defined(SKITTER_DEBUG_BUILD)
  std::fprintf(stderr, "crowd_bench: this is a debug build; configure with --preset release\n");
  return 2;
#endif
  benchmark::Initialize(&argc, argv);
  int64_t agents = kAgents;
  if (argc == 2 && std::sscanf(argv[1], "--agents=%" SCNd64, &agents) == 1 && agents > 0 &&
      agents <= Scene::maxAgents)
    argc = 1;
  addAll(agents);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  try {
    std::fprintf(stderr, "%s", bench::machineLines(device().report(), bench::opponentBuild()).c_str());
    benchmark::RunSpecifiedBenchmarks();
  } catch (const Error& error) {
    std::fprintf(stderr, "crowd_bench: %s\n", error.what());
    return static_cast<int>(error.kind());
  }
  benchmark::Shutdown();
  return 0;
}

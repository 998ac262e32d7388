#include "bench/crowd/contest.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <thread>

#include "base/clock.h"
#include "bench/crowd/contestant.h"
#include "bench/statistics.h"
#include "crowd/herd.h"
#include "crowd/stage.h"
#include "validation/herd_facts.h"
#include "validation/replay.h"

namespace skitter::bench {
namespace {

// Counted ones; the tick before them fills the caches that the other contestants took.
constexpr uint32_t kFewestTicksATurn = 2, kMostTicksATurn = 500;
// Stages are timed in ticks of their own, for their clocks cost: a timestamp takes lavapipe as long as a
// small dispatch.
constexpr uint32_t kTicksAWatchedOne = 4;
// The reference takes about a millisecond for one of them.
constexpr uint32_t kAgentsChecked = 1024;

// A tick's states before and after, of every herd, size by size (crowd::allRuns).
struct Witness {
  std::vector<HerdState> before, after;
};

// One contestant and what its turns took, a tick; by stage the sum of the turns.
struct Corner {
  std::unique_ptr<Contestant> contestant;
  std::vector<double> wall = {}, cpu = {};
  std::vector<StageTime> stages = {};
  Witness witness = {};  // of a counted tick
};

// For large herds, only the agents that `seed` draws for the tick `tick`.
std::vector<HerdState> statesOf(const Crowd& crowd, const Contestant& contestant, uint64_t tick,
                                uint64_t seed) {
  std::vector<HerdState> states;
  for (const crowd::HerdRun& of : crowd::allRuns(implOf(crowd)))
    states.push_back(contestant.state(static_cast<uint32_t>(states.size()),
                                      validation::sampleAt(seed, tick, of.run->agents, kAgentsChecked)));
  return states;
}

std::vector<validation::StageResult> judge(const Crowd& crowd, const Witness& witness,
                                           const std::vector<StageDemand>& timed) {
  const Crowd::Impl& impl = implOf(crowd);
  const std::vector<crowd::HerdRun> runs = crowd::allRuns(impl);
  std::vector<validation::StageResult> results;
  for (size_t r = 0; r < runs.size(); ++r) {
    validation::Replay replay(validation::herdFacts(impl, runs[r]));
    replay.tick(witness.after[r].tick, witness.before[r], witness.after[r]);
    for (const validation::StageResult& result : replay.results())
      if (std::any_of(timed.begin(), timed.end(),
                      [&](const StageDemand& d) { return crowd::makes(d.stage, result.name); }))
        results.push_back(result);
  }
  return results;
}

Spread spreadOf(const std::vector<double>& values) {
  return {quantile(values, 0.5), quantile(values, 0.25), quantile(values, 0.75)};
}

std::vector<Corner> cornersOf(Device& device, Crowd& crowd, const ContestOptions& options) {
  std::vector<Corner> corners;
  const auto enter = [&](std::unique_ptr<Contestant> contestant) {
    corners.push_back({.contestant = std::move(contestant)});
  };
  enter(deviceContestant(device, crowd, static_cast<float>(options.dt)));
  if (!hasCpuContestant(crowd)) return corners;
  const int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  if (threads > 1) enter(cpuContestant(crowd, false, threads, options.crowd.pose));
  enter(cpuContestant(crowd, false, 1, options.crowd.pose));
  if (options.scalar) enter(cpuContestant(crowd, true, 1, options.crowd.pose));
  return corners;
}

// The clocks stop while `states` keeps those before and after the counted tick `witnessed`.
void takeTurn(Corner& corner, uint32_t ticks, std::optional<uint32_t> witnessed,
              const std::function<std::vector<HerdState>(const Contestant&)>& states) {
  corner.contestant->timeStages(false);
  corner.contestant->tick();
  corner.contestant->finish();
  base::Seconds spent;
  const auto count = [&](uint32_t some) {
    spent += base::timed([&] {
      for (uint32_t t = 0; t < some; ++t) corner.contestant->tick();
      corner.contestant->finish();
    });
  };
  if (witnessed) {
    count(*witnessed);
    corner.witness.before = states(*corner.contestant);
    count(1);
    corner.witness.after = states(*corner.contestant);
    count(ticks - *witnessed - 1);
  } else {
    count(ticks);
  }
  const uint32_t watched = std::max(kFewestTicksATurn, ticks / kTicksAWatchedOne);
  const std::vector<StageTime> before = corner.contestant->stageTimes();
  corner.contestant->timeStages(true);
  for (uint32_t t = 0; t < watched; ++t) corner.contestant->tick();
  for (const StageTime& time : before) add(corner.stages, time.stage, -time.milliseconds / watched);
  for (const StageTime& time : corner.contestant->stageTimes())
    add(corner.stages, time.stage, time.milliseconds / watched);
  corner.wall.push_back(1e3 * spent.wall / ticks);
  corner.cpu.push_back(1e3 * spent.cpu / ticks);
}

}  // namespace

std::vector<validation::StageResult> checkTick(const Crowd& crowd, Contestant& contestant, uint64_t tick,
                                               const std::vector<StageDemand>& timed, uint64_t seed) {
  Witness witness;
  witness.before = statesOf(crowd, contestant, tick, seed);
  contestant.tick();
  witness.after = statesOf(crowd, contestant, tick, seed);
  return judge(crowd, witness, timed);
}

Match contest(Device& device, const Heightfield& terrain, const Scene& scene, const ContestOptions& options,
              const std::function<void(double)>& step, const std::function<bool()>& stopped) {
  Crowd crowd(device, terrain, scene, options.crowd);
  Match match;
  match.agents = crowd.agentCount();
  match.memoryBytes = crowd.memoryBytes();
  double tickSeconds = 0;
  {
    const std::unique_ptr<Contestant> warm = deviceContestant(device, crowd, static_cast<float>(options.dt));
    warm->timeStages(false);
    for (uint32_t i = 0; i < options.warmUp; ++i) {
      if (stopped()) return {};
      const double seconds = base::timed([&] {
                               warm->tick();
                               warm->finish();
                             }).wall;
      tickSeconds = i == 0 ? seconds : std::min(tickSeconds, seconds);
      step(0.2 * (i + 1) / options.warmUp);
    }
  }
  match.ticks =
      static_cast<uint32_t>(std::clamp(std::round(options.turnSeconds / std::max(tickSeconds, 1e-6)),
                                       double{kFewestTicksATurn}, double{kMostTicksATurn}));

  std::vector<Corner> corners = cornersOf(device, crowd, options);
  // Drawn, so that no tick is known to be looked at.
  std::mt19937_64 random(options.seed);
  const uint64_t witnessedRound = random() % options.rounds;
  const auto witnessedTick = static_cast<uint32_t>(random() % match.ticks);
  const uint64_t sample = crowd.tick();
  for (uint32_t round = 0; round < options.rounds; ++round)
    for (size_t i = 0; i < corners.size(); ++i) {
      if (stopped()) return {};
      // Another one begins each round, so that nobody always follows the same one.
      Corner& corner = corners[(i + round) % corners.size()];
      takeTurn(corner, match.ticks, round == witnessedRound ? std::optional(witnessedTick) : std::nullopt,
               [&](const Contestant& c) { return statesOf(crowd, c, sample, options.seed); });
      step(0.2 +
           0.7 * (round + static_cast<double>(i + 1) / static_cast<double>(corners.size())) / options.rounds);
    }
  match.demands = demandOf(crowd, options.crowd);

  for (Corner& corner : corners) {
    if (stopped()) return {};
    Result& result = match.results.emplace_back();
    result.name = corner.contestant->name();
    result.threads = corner.contestant->threads();
    result.wall = spreadOf(corner.wall);
    result.cpu = spreadOf(corner.cpu);
    for (StageTime& stage : corner.stages) stage.milliseconds /= options.rounds;
    result.stages = std::move(corner.stages);
    result.checkedTick = corner.witness.after.front().tick;
    result.checks = judge(crowd, corner.witness, match.demands);
    result.pass = std::all_of(result.checks.begin(), result.checks.end(),
                              [](const validation::StageResult& c) { return c.pass; });
    corner.contestant.reset();
    step(0.9 + 0.1 * static_cast<double>(match.results.size()) / static_cast<double>(corners.size()));
  }
  return match;
}

}  // namespace skitter::bench

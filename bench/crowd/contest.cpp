#include "bench/crowd/contest.h"

#include <algorithm>
#include <memory>
#include <thread>

#include "bench/crowd/contestant.h"
#include "crowd/herd.h"
#include "crowd/stage.h"
#include "validation/herd_facts.h"
#include "validation/replay.h"

namespace skitter::bench {
namespace {

// The reference takes about a millisecond for one of them.
constexpr uint32_t kAgentsChecked = 1024;

// A tick's states before and after, of every herd, size by size (crowd::allRuns).
struct Witness {
  std::vector<HerdState> before, after;
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

std::vector<std::unique_ptr<Contestant>> contestantsOf(Device& device, Crowd& crowd,
                                                       const ContestOptions& options) {
  std::vector<std::unique_ptr<Contestant>> all;
  all.push_back(deviceContestant(device, crowd, static_cast<float>(options.dt)));
  if (!hasCpuContestant(crowd)) return all;
  const int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  if (threads > 1) all.push_back(cpuContestant(crowd, false, threads, options.crowd.pose));
  all.push_back(cpuContestant(crowd, false, 1, options.crowd.pose));
  if (options.scalar) all.push_back(cpuContestant(crowd, true, 1, options.crowd.pose));
  return all;
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
  {
    const std::unique_ptr<Contestant> warm = deviceContestant(device, crowd, static_cast<float>(options.dt));
    warm->timeStages(false);
    for (uint32_t i = 0; i < options.warmUp; ++i) {
      if (stopped()) return {};
      warm->tick();
      warm->finish();
      step(0.2 * (i + 1) / options.warmUp);
    }
  }

  std::vector<std::unique_ptr<Contestant>> contestants = contestantsOf(device, crowd, options);
  std::vector<Corner> corners;
  for (const auto& contestant : contestants)
    corners.push_back({*contestant, ticksATurn(*contestant, options.turnSeconds)});
  std::vector<Witness> witnesses(corners.size());
  const uint64_t sample = crowd.tick();
  const auto states = [&](size_t i) { return statesOf(crowd, *contestants[i], sample, options.seed); };
  if (!takeTurns(
          corners, {options.rounds, options.seed}, [&](size_t i) { witnesses[i].before = states(i); },
          [&](size_t i) { witnesses[i].after = states(i); }, [&](double share) { step(0.2 + 0.7 * share); },
          stopped))
    return {};
  match.demands = demandOf(crowd, options.crowd);

  for (size_t i = 0; i < corners.size(); ++i) {
    if (stopped()) return {};
    Result& result = match.results.emplace_back(resultOf(corners[i], options.rounds));
    result.checkedTick = witnesses[i].after.front().tick;
    addChecks(result, judge(crowd, witnesses[i], match.demands));
    contestants[i].reset();
    step(0.9 + 0.1 * static_cast<double>(match.results.size()) / static_cast<double>(corners.size()));
  }
  return match;
}

}  // namespace skitter::bench

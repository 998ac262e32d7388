#include "bench/crowd/turns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "base/clock.h"
#include "bench/statistics.h"

namespace skitter::bench {
namespace {

// Counted ones; the tick before them fills the caches that the other contestants took.
constexpr uint32_t kFewestTicksATurn = 2, kMostTicksATurn = 500;
constexpr int kTicksToKnow = 2;  // of which the better one tells how long a tick takes
// Stages are timed in ticks of their own, for their clocks cost: a timestamp takes lavapipe as long as a
// small dispatch.
constexpr uint32_t kTicksAWatchedOne = 4;

// What is done around the counted tick of that number.
struct WitnessedTick {
  uint32_t tick;
  std::function<void()> before, after;
};

void takeTurn(Corner& corner, const std::optional<WitnessedTick>& witness) {
  Runner& runner = corner.runner;
  const uint32_t ticks = corner.ticks;
  runner.timeStages(false);
  runner.tick();
  runner.finish();
  base::Seconds spent;
  const auto count = [&](uint32_t some) {
    spent += base::timed([&] {
      for (uint32_t t = 0; t < some; ++t) runner.tick();
      runner.finish();
    });
  };
  if (witness) {
    count(witness->tick);
    witness->before();
    count(1);
    witness->after();
    count(ticks - witness->tick - 1);
  } else {
    count(ticks);
  }
  const uint32_t watched = std::max(kFewestTicksATurn, ticks / kTicksAWatchedOne);
  const std::vector<StageTime> before = runner.stageTimes();
  runner.timeStages(true);
  for (uint32_t t = 0; t < watched; ++t) runner.tick();
  for (const StageTime& time : before) add(corner.stages, time.stage, -time.milliseconds / watched);
  for (const StageTime& time : runner.stageTimes())
    add(corner.stages, time.stage, time.milliseconds / watched);
  corner.wall.push_back(1e3 * spent.wall / ticks);
  corner.cpu.push_back(1e3 * spent.cpu / ticks);
}

Spread spreadOf(const std::vector<double>& values) {
  return {quantile(values, 0.5), quantile(values, 0.25), quantile(values, 0.75)};
}

}  // namespace

void add(std::vector<StageTime>& sums, const std::string& stage, double milliseconds) {
  const auto known = std::ranges::find(sums, stage, &StageTime::stage);
  if (known == sums.end())
    sums.push_back({stage, milliseconds});
  else
    known->milliseconds += milliseconds;
}

uint32_t ticksATurn(Runner& runner, double turnSeconds) {
  runner.timeStages(false);
  double tickSeconds = std::numeric_limits<double>::max();
  for (int i = 0; i < kTicksToKnow; ++i)
    tickSeconds = std::min(tickSeconds, base::timed([&] {
                                          runner.tick();
                                          runner.finish();
                                        }).wall);
  return static_cast<uint32_t>(std::clamp(std::round(turnSeconds / std::max(tickSeconds, 1e-6)),
                                          double{kFewestTicksATurn}, double{kMostTicksATurn}));
}

bool takeTurns(std::vector<Corner>& corners, const TurnPlan& plan, const std::function<void(size_t)>& before,
               const std::function<void(size_t)>& after, const std::function<void(double)>& step,
               const std::function<bool()>& stopped) {
  // Drawn, so that no tick is known to be looked at.
  std::mt19937_64 random(plan.seed);
  const uint64_t witnessedRound = random() % plan.rounds;
  const uint64_t witnessedTick = random();  // modulo the ticks of a turn
  for (uint32_t round = 0; round < plan.rounds; ++round)
    for (size_t i = 0; i < corners.size(); ++i) {
      if (stopped()) return false;
      // Another one begins each round, so that nobody always follows the same one.
      const size_t at = (i + round) % corners.size();
      std::optional<WitnessedTick> witness;
      if (round == witnessedRound)
        witness = {static_cast<uint32_t>(witnessedTick % corners[at].ticks), [&] { before(at); },
                   [&] { after(at); }};
      takeTurn(corners[at], witness);
      step((round + static_cast<double>(i + 1) / static_cast<double>(corners.size())) / plan.rounds);
    }
  return true;
}

Result resultOf(const Corner& corner, uint32_t rounds) {
  Result result;
  result.name = corner.runner.name();
  result.threads = corner.runner.threads();
  result.ticks = corner.ticks;
  result.wall = spreadOf(corner.wall);
  result.cpu = spreadOf(corner.cpu);
  result.stages = corner.stages;
  for (StageTime& stage : result.stages) stage.milliseconds /= rounds;
  return result;
}

void addChecks(Result& result, const std::vector<validation::StageResult>& checks) {
  result.checks.insert(result.checks.end(), checks.begin(), checks.end());
  result.pass = std::ranges::all_of(result.checks, &validation::StageResult::pass);
}

}  // namespace skitter::bench

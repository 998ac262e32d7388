#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/crowd/contestant.h"
#include "bench/crowd/demand.h"
#include "bench/crowd/turns.h"
#include "skitter/crowd.h"
#include "validation/judge.h"

namespace skitter::bench {

struct ContestOptions {
  CrowdOptions crowd;         // of the device's; poses for all contestants
  double dt = 1.0 / 60;       // seconds a tick
  uint32_t warmUp = 60;       // ticks on the device before anybody starts, from the state that they lead to
  uint32_t rounds = 7;        // in each of which everybody has a turn
  double turnSeconds = 0.25;  // about what the counted ticks of a turn take
  bool scalar = true;         // with the scalar opponent
  uint64_t seed = 1;          // decides which agents are checked
};

struct Match {
  uint64_t agents = 0;
  uint64_t memoryBytes = 0;  // of the device's records
  std::vector<Result>
      results;  // the device's first; CPU opponents where there are any for the scene's controllers
  std::vector<StageDemand> demands;
};

// One more tick of the contestant, `tick`, in lock-step against the reference: of every herd the stages that
// `timed` names, of large herds about a thousand agents.
std::vector<validation::StageResult> checkTick(const Crowd&, Contestant&, uint64_t tick,
                                               const std::vector<StageDemand>& timed, uint64_t seed);

// Lets the device and the CPU animate the same crowd from the same state, turn by turn in one run, and checks
// a counted tick of each in lock-step against the reference. `step` is called with the share that is done;
// `stopped` ends it early with an empty match.
Match contest(Device&, const Heightfield&, const Scene&, const ContestOptions&,
              const std::function<void(double)>& step, const std::function<bool()>& stopped);

}  // namespace skitter::bench

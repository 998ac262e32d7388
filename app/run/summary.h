#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/common/simulate.h"
#include "app/run/crowding_watch.h"
#include "app/run/damage.h"
#include "app/run/forage_log.h"
#include "laws/tally.h"
#include "skitter/crowd.h"
#include "skitter/device.h"

namespace skitter::app {

template <class T>
nlohmann::ordered_json orNull(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nullptr;
}

struct HerdFigures {
  uint32_t number = 0;
  std::string rig;
  uint32_t agents = 0;
  uint32_t cannotReach = 0;  // their goals, of these
  Fidelity fidelity;
};

// A herd with reactions has these figures; they begin when its agents come.
struct ReactionFigures {
  uint32_t herd = 0;
  uint64_t falls = 0, stands = 0;  // of all its agents
  uint64_t down = 0;               // agents that are fallen or rise, at the end
  double seconds = 0;              // of all falls from which somebody stands again

  // From the beginning of a fall to standing, a mean.
  std::optional<double> standUpSeconds() const;
};
std::vector<ReactionFigures> reactionFigures(const Crowd& crowd);

// A herd that adapts has these figures, of its agents at the end.
struct SearchFigures {
  uint32_t herd = 0;
  uint64_t searching = 0, settled = 0;
  std::vector<uint32_t> trials = {};  // of each who is settled, ascending
  double sumOfBest = 0;               // of their highest fitnesses

  std::optional<uint32_t> trialsMedian() const;
  std::optional<uint32_t> trialsMost() const;
  std::optional<double> fitness() const;  // the mean
};
std::vector<SearchFigures> searchFigures(const Crowd& crowd);

// What a run came to: printed for people and written for programs.
struct Summary {
  std::string device;
  std::string terrain;  // name, samples and metres
  uint64_t filledVoids = 0;
  uint64_t agents = 0, ticks = 0, frames = 0, seed = 0;
  std::optional<uint64_t> resumedAt;    // the tick of the state that the run went on from
  std::optional<uint64_t> wantedTicks;  // none where a window runs until it is closed
  bool interrupted = false;
  TickTimes times;
  std::vector<StageTime> drawing;  // sums over all frames; empty unless asked for
  bool cpuTold = true;             // the CPU time is the simulation's alone
  uint32_t watchEvery = 1;         // the figures are of one agent of this many at a time
  Fidelity fidelity;               // of all herds
  std::vector<HerdFigures> herds;  // that are there at the end
  Crowding crowding;
  std::vector<ForageFigures> foraging;     // of the herds that forage
  std::vector<ReactionFigures> reactions;  // of the herds with reactions
  std::vector<SearchFigures> searches;     // of the herds that adapt
  Jams jams;
  std::vector<LevelFigures> levels;                   // where there are levels of rate
  std::optional<DamageFigures> damage;                // where events hurt legs, and it was asked for
  std::optional<std::vector<laws::Figure>> warnings;  // laws that were broken; none without a judge
  std::optional<uint64_t> sleeping;                   // agents at the end; none where they may not
  std::optional<double> lawSeconds;  // CPU time that judging took; told with the stages' times
  uint64_t stateHash = 0;
  std::vector<MemoryUse> memory;                 // of all herds; told with the stages' times
  double startSeconds = 0, startCpuSeconds = 0;  // before the first tick; told likewise
  std::vector<std::string> files;

  void print() const;
  nlohmann::ordered_json json() const;
};

}  // namespace skitter::app

#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "skitter/crowd.h"
#include "validation/judge.h"

// How those who do the same work are timed, turn by turn in one run.
namespace skitter::bench {

// Who does it tick by tick: the device, or an opponent on the CPU.
class Runner {
 public:
  virtual ~Runner() = default;
  virtual std::string name() const = 0;
  virtual int threads() const = 0;  // of the CPU that it may use; 0: the device's own
  virtual void tick() = 0;          // one; the device's may go on while the next one is recorded
  virtual void finish() {}          // waits for what goes on
  // Whether ticks from now on are timed stage by stage, which the device does not get for nothing.
  virtual void timeStages(bool on) = 0;
  // Milliseconds of all ticks so timed, by stage: the device's clock, or CPU time of all threads.
  virtual std::vector<StageTime> stageTimes() const = 0;
};

// To the stage's sum, which begins with its first time.
void add(std::vector<StageTime>& sums, const std::string& stage, double milliseconds);

// Over the rounds, milliseconds a tick.
struct Spread {
  double median = 0, low = 0, high = 0;  // quartiles
};

struct Result {
  std::string name;
  int threads = 0;                              // of the CPU that it may use; 0: the device
  Spread wall, cpu;                             // cpu: of all threads of the process
  std::vector<StageTime> stages;                // a tick: the device's clock, or CPU time
  uint32_t ticks = 0;                           // of a turn that are counted
  uint64_t checkedTick = 0;                     // a counted tick of one of the turns, drawn by the seed
  std::vector<validation::StageResult> checks;  // of that tick
  bool pass = false;                            // all of them
};

// One who competes, and what its turns took, a tick; by stage the sum of the turns.
struct Corner {
  Runner& runner;
  uint32_t ticks;  // of a turn that are counted: two or more, after one that is not
  std::vector<double> wall = {}, cpu = {};
  std::vector<StageTime> stages = {};
};

struct TurnPlan {
  uint32_t rounds = 7;  // in each of which everybody has a turn
  uint64_t seed = 1;    // draws the tick that is witnessed
};

// So many ticks of the runner as take about `turnSeconds`. Runs a few to know.
uint32_t ticksATurn(Runner&, double turnSeconds);

// Everybody's turns, round after round. One counted tick of each is witnessed: the clocks stop while
// `before` and `after`, which are told the number of the corner, look at what it has. `step` is called with
// the share that is done. False where `stopped` ended it early.
bool takeTurns(std::vector<Corner>& corners, const TurnPlan& plan, const std::function<void(size_t)>& before,
               const std::function<void(size_t)>& after, const std::function<void(double)>& step,
               const std::function<bool()>& stopped);

// Without checks.
Result resultOf(const Corner& corner, uint32_t rounds);
// Adds them, and whether all passed.
void addChecks(Result& result, const std::vector<validation::StageResult>& checks);

}  // namespace skitter::bench

#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gpu/submit.h"
#include "skitter/crowd.h"

namespace skitter::bench {

// Who animates a crowd tick by tick: the device, or an opponent on the CPU.
class Contestant {
 public:
  virtual ~Contestant() = default;
  virtual std::string name() const = 0;
  virtual int threads() const = 0;  // of the CPU that it may use; 0: the device's own
  virtual void tick() = 0;          // one; the device's may go on while the next one is recorded
  virtual void finish() {}          // waits for what goes on
  // The records of one of crowd::allRuns(), without metrics.
  virtual HerdState state(uint32_t run, const AgentSample& sample) const = 0;
  // Whether ticks from now on are timed stage by stage, which the device does not get for nothing.
  virtual void timeStages(bool on) = 0;
  // Milliseconds of all ticks so timed, by stage: the device's clock, or CPU time of all threads.
  virtual std::vector<StageTime> stageTimes() const = 0;
};

// To the stage's sum, which begins with its first time.
void add(std::vector<StageTime>& sums, const std::string& stage, double milliseconds);

std::unique_ptr<Contestant> deviceContestant(Device&, Crowd&, float dt);
// From the crowd's present state on. `scalar` does with one float what it else does with a register of them.
std::unique_ptr<Contestant> cpuContestant(const Crowd&, bool scalar, int threads, bool poses);
// How the CPU's contestants were compiled.
std::string opponentBuild();
// Whether there is one for every herd of the crowd.
bool hasCpuContestant(const Crowd&);

}  // namespace skitter::bench

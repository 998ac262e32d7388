#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/crowd/turns.h"
#include "gpu/submit.h"
#include "skitter/crowd.h"

namespace skitter::bench {

// Who animates a crowd tick by tick.
class Contestant : public Runner {
 public:
  // The records of one of crowd::allRuns(), without metrics.
  virtual HerdState state(uint32_t run, const AgentSample& sample) const = 0;
};

std::unique_ptr<Contestant> deviceContestant(Device&, Crowd&, float dt);
// From the crowd's present state on. `scalar` does with one float what it else does with a register of them.
std::unique_ptr<Contestant> cpuContestant(const Crowd&, bool scalar, int threads, bool poses);
// How the CPU's contestants were compiled.
std::string opponentBuild();
// Whether there is one for every herd of the crowd.
bool hasCpuContestant(const Crowd&);

}  // namespace skitter::bench

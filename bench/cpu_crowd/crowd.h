#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "skitter/crowd.h"
#include "validation/replay.h"

// The opponent of the engine's crowd: the same tick (docs/stages.md) in single precision on the CPU, as fast
// as can be written. validation::Replay judges it as it judges a device.
namespace skitter::cpu_crowd {

// Agents to an instruction. Both are the same source: what it does to a register of floats it does to one.
enum class Width { scalar, simd };

struct Options {
  int threads = 1;  // at least 1, the caller's among them
  Width width = Width::simd;
  bool poses = false;  // bone rotations and positions, as CrowdOptions::pose
};

// All flags that its kernels are compiled with, the compiler and the lanes.
std::string buildDescription();

struct StageSeconds {
  std::string stage;
  double seconds = 0;  // of CPU time, of all threads together
};

// One herd, adaptive or clip, on ground that stays as it is: no edits, no measure, no footfalls. Not
// thread-safe.
class CpuCrowd {
 public:
  // Copies what it needs of `facts` and `start`, a state read back from a device (or from another CpuCrowd).
  // Throws Error(input) where the records' sizes do not fit the rig, for a controller other than adaptive and
  // clip, and of adaptive for an ik plan other than the active set's.
  CpuCrowd(const validation::HerdFacts& facts, const HerdState& start, const Options& options);
  ~CpuCrowd();
  CpuCrowd(const CpuCrowd&) = delete;
  CpuCrowd& operator=(const CpuCrowd&) = delete;

  // Tick `n`, counted from 1 as Crowd::tick is after it: one more than the tick that the state is of.
  // Allocates nothing. The number of threads does not change a bit of the result.
  void tick(uint64_t n);
  // The foothold stage of tick `n` only: the herd's first `legs` legs, counted agent by agent, lift and begin
  // a step. On one thread. Throws Error(input) for a clip herd, and where the herd has fewer legs.
  void beginSteps(uint64_t n, size_t legs);
  // Whether ticks from now on are timed stage by stage, at first not: reading clocks costs some nanoseconds
  // an agent.
  void timeStages(bool on);

  // Records in the device's layout, without metrics, and without poses unless Options::poses. Those of stages
  // that are not run are 0: of clip, all of the legs'.
  HerdState state() const;
  std::vector<StageSeconds> stageSeconds() const;  // of the ticks so timed, in the tick's order
  size_t bytesAnAgent() const;                     // of state that a tick reads and writes, poses among it

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace skitter::cpu_crowd

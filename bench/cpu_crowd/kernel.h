#pragma once

#include <memory>

#include "bench/cpu_crowd/crowd.h"
#include "bench/cpu_crowd/rig.h"

namespace skitter::cpu_crowd {

// A herd of one controller, for one kind of lanes: its state, and the tick of a part of it. Parts are
// independent of each other, so threads may take them in any order; `thread` names the scratch memory to use.
class Kernel {
 public:
  virtual ~Kernel() = default;
  virtual size_t parts() const = 0;
  virtual void tick(uint64_t n, size_t part, int thread, bool timed) = 0;
  virtual void beginSteps(uint64_t n, size_t legs) = 0;
  virtual void read(HerdState& state) const = 0;
  virtual size_t bytes() const = 0;
  virtual std::vector<StageSeconds> stageSeconds() const = 0;
};

// A file each, for they are large.
std::unique_ptr<Kernel> simdKernel(const World& world, const HerdState& start, const Options& options);
std::unique_ptr<Kernel> scalarKernel(const World& world, const HerdState& start, const Options& options);

}  // namespace skitter::cpu_crowd

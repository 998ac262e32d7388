#pragma once

#include <memory>

#include "bench/ik/problem.h"
#include "bench/ik/quality.h"

namespace skitter::bench {

// Who solves a batch. aim() is not timed, solve() is.
class Contestant {
 public:
  virtual ~Contestant() = default;
  virtual void aim(size_t set) = 0;  // at one of the sets of targets
  virtual void solve() = 0;
  virtual Results results() const = 0;
};

struct Task {
  const baseline::Chain& chain;
  const baseline::Model& model;
  const Targets& targets;
  uint32_t chains;
  ik::Start start;
};

std::unique_ptr<Contestant> onDevice(Device&, const Task&, const Entry&);
// entry.cpu is there.
std::unique_ptr<Contestant> onCpu(const Task&, const Entry&, bool simd);

}  // namespace skitter::bench

#pragma once

#include <array>
#include <chrono>
#include <vector>

#include "bench/cpu_crowd/crowd.h"

namespace skitter::cpu_crowd {

// Seconds of each of a herd's stages, in its order.
using Seconds = std::array<double, 8>;

// Clocks stages as they follow each other, or nothing.
class Laps {
 public:
  explicit Laps(Seconds* sums) : sums_(sums) {
    if (sums_ != nullptr) last_ = Clock::now();
  }
  void end(int stage) {
    if (sums_ == nullptr) return;
    const auto now = Clock::now();
    (*sums_)[size_t(stage)] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Seconds* sums_;
  Clock::time_point last_;
};

// Sums of all threads' seconds by the stages' names.
template <class Scratch>
std::vector<StageSeconds> sumOf(const std::vector<Scratch>& threads, const std::vector<const char*>& names) {
  std::vector<StageSeconds> all;
  for (size_t s = 0; s < names.size(); ++s) {
    all.push_back({names[s], 0});
    for (const Scratch& scratch : threads) all.back().seconds += scratch.seconds[s];
  }
  return all;
}

}  // namespace skitter::cpu_crowd

#pragma once

#include <array>
#include <vector>

#include "base/clock.h"
#include "bench/cpu_crowd/crowd.h"

namespace skitter::cpu_crowd {

// One for each of a herd's stages, in the herd's order.
using Seconds = std::array<double, 8>;

// Clocks the stages of a part of a herd as they follow each other, or nothing. Laps are of the wall, whose
// clock is read quickly; in the end they share out what the thread was given of the CPU.
class Laps {
 public:
  explicit Laps(Seconds* sums) : sums_(sums) {
    if (sums_ == nullptr) return;
    begin_ = base::threadSeconds();
    last_ = base::wallSeconds();
  }
  Laps(const Laps&) = delete;
  Laps& operator=(const Laps&) = delete;
  ~Laps() {
    if (sums_ == nullptr) return;
    double wall = 0;
    for (const double lap : laps_) wall += lap;
    const double share = (base::threadSeconds() - begin_) / wall;
    for (size_t s = 0; s < laps_.size(); ++s) (*sums_)[s] += laps_[s] * share;
  }

  // A stage over some blocks.
  template <class Work>
  void stage(size_t index, size_t first, size_t last, const Work& work) {
    for (size_t block = first; block < last; ++block) work(block);
    end(index);
  }

  void end(size_t stage) {
    if (sums_ == nullptr) return;
    const double now = base::wallSeconds();
    laps_[stage] += now - last_;
    last_ = now;
  }

 private:
  Seconds* sums_;
  Seconds laps_{};
  double begin_ = 0, last_ = 0;
};

// Sums of all threads' seconds, under the stages' names.
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

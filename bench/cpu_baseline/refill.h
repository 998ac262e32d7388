#pragma once

#include <bit>

#include "bench/cpu_baseline/batch.h"
#include "bench/cpu_baseline/lane_vector.h"

namespace skitter::baseline {

// Chains [first, last) of a batch, the first a multiple of Rows::kGroup.
struct Range {
  size_t first, last;
};

// The bones of the arrays that a kernel for N bones declares: N, or the most there are where N is 0 and the
// count is known only when it runs.
template <int N>
inline constexpr int kCapacity = N > 0 ? N : kMaxBones;
template <int N>
int boneCount(const Model& model) {
  return N > 0 ? N : model.bones;
}

template <class F>
Mask<F> firstLanes(size_t count) {
  F index;
  for (int i = 0; i < kWidth<F>; ++i) lane(index, i) = float(i);
  return index < F(float(count));
}

template <class State>
void copyLane(State& to, int i, const State& from, int j) {
  using F = typename State::Lane;
  constexpr int kRows = sizeof(State) / sizeof(F);
  float* target = reinterpret_cast<float*>(&to) + i;
  const float* source = reinterpret_cast<const float*>(&from) + j;
  for (int row = 0; row < kRows; ++row) target[row * kWidth<F>] = source[row * kWidth<F>];
}

// Chains staged a register's worth at a time, which its kernel starts together, and handed out one by one.
template <class Kernel>
class Feed {
 public:
  using State = typename Kernel::State;
  static constexpr int kChains = kWidth<typename Kernel::Lane>;

  Feed(Kernel& kernel, Range range) : kernel_(kernel), next_(range.first), last_(range.last) {}

  // False where none is left that needs to be iterated.
  bool advance() {
    while (waiting_ == 0) {
      if (next_ >= last_) return false;
      base_ = next_;
      next_ += kChains;
      waiting_ = kernel_.start(staged_, base_, std::min<size_t>(kChains, last_ - base_));
    }
    return true;
  }
  // The chain that has come into lane `i`.
  size_t take(State& state, int i) {
    const int j = std::countr_zero(waiting_);
    waiting_ &= waiting_ - 1;
    copyLane(state, i, staged_, j);
    return base_ + j;
  }
  const State& staged() const { return staged_; }

 private:
  Kernel& kernel_;
  State staged_;
  size_t base_ = 0, next_, last_;
  uint64_t waiting_ = 0;
};

// Iterates all chains of the range. Lanes in lockstep would wait for their slowest (of eight, more than twice
// the mean), so a lane whose chain is done takes the next chain at once.
//
// A Kernel has Lane, State (of Lanes only) and
//   uint64_t start(State&, size_t chain, size_t count)  starts chains together; those that need no iteration
//                                                       are finished, the bits of the others returned
//   uint64_t step(State&)                               iterates all; the lanes to look at
//   bool settle(State&, int lane, size_t chain)         of such a lane: true if its chain is finished
template <class Kernel>
void solveRange(Kernel& kernel, Range range) {
  constexpr int kChains = Feed<Kernel>::kChains;
  Feed<Kernel> feed(kernel, range);
  if (!feed.advance()) return;
  typename Kernel::State state = feed.staged();  // so that idle lanes, too, hold a chain
  size_t chain[kChains];
  uint64_t busy = 0;
  for (int i = 0; i < kChains && feed.advance(); ++i) {
    chain[i] = feed.take(state, i);
    busy |= uint64_t(1) << i;
  }
  while (busy != 0) {
    for (uint64_t look = kernel.step(state) & busy; look != 0; look &= look - 1) {
      const int i = std::countr_zero(look);
      if (!kernel.settle(state, i, chain[i])) continue;
      if (feed.advance()) {
        chain[i] = feed.take(state, i);
      } else {
        busy &= ~(uint64_t(1) << i);
      }
    }
  }
}

}  // namespace skitter::baseline

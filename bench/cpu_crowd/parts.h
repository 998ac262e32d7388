#pragma once

#include <algorithm>

#include "bench/cpu_crowd/lanes.h"

namespace skitter::cpu_crowd {

// How a herd of blocks of F is cut. A group's state stays in the nearest cache through the stages that follow
// each other; a part is what a thread takes, small enough for the second cache and large enough that the few
// legs that begin a step in it fill the lanes.
template <class F>
struct Parts {
  static constexpr size_t kAgents = kWidth<F>;                                                // a block
  static constexpr size_t kGroup = std::max<size_t>(16 / kAgents, 1), kPart = 128 / kAgents;  // blocks

  static size_t blocks(size_t agents) { return (agents + kAgents - 1) / kAgents; }
  static size_t count(size_t blocks) { return (blocks + kPart - 1) / kPart; }

  // work(first, last) for each group of a part.
  template <class Work>
  static void eachGroup(size_t part, size_t blocks, const Work& work) {
    const size_t end = std::min((part + 1) * kPart, blocks);
    for (size_t first = part * kPart; first < end; first += kGroup)
      work(first, std::min(first + kGroup, end));
  }
};

}  // namespace skitter::cpu_crowd

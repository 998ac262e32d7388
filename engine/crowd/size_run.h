#pragma once

#include <cstdint>

namespace skitter::crowd {

// The agents of a herd that are equally large: a run of the herd's agents, and of their kind's.
struct SizeRun {
  uint32_t kind = 0;         // which of the crowd's
  uint32_t place = 0;        // the herd's among the kind's herds
  uint32_t firstAgent = 0;   // of the kind
  uint32_t firstOfHerd = 0;  // the number of the same agent in the herd
  uint32_t agents = 0;       // its places

  // The number in the kind of an agent that has `agent` in the herd.
  uint32_t ofKind(uint32_t agent) const { return firstAgent + agent - firstOfHerd; }
};

}  // namespace skitter::crowd

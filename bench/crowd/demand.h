#pragma once

#include <string>
#include <vector>

#include "skitter/crowd.h"

namespace skitter::bench {

// What a tick asks of the device in one stage, all agents together.
struct StageDemand {
  std::string stage;
  double bytes = 0;  // of the records that its invocations load and store, each once a dispatch; of foothold
                     // those of the legs listed in the last tick
  double operations =
      0;  // single-precision (operations.h), of the first dispatch or, of foothold, of the legs listed
};

// The demand of the stages that a tick without measure and footfalls records. Waits for the device.
std::vector<StageDemand> demandOf(const Crowd& crowd, const CrowdOptions& options);

}  // namespace skitter::bench

#pragma once

#include "bench/ik/clock.h"
#include "bench/ik/problem.h"
#include "bench/ik/quality.h"
#include "skitter/device.h"

namespace skitter::bench {

// One batch on the device under options of one's own, judged, then timed.
struct MeasuredBatch {
  Quality quality;
  double seconds =
      0;  // of a whole batch, median: CPU time of all threads on a software device, else the wall's
  double wallSeconds = 0;
};

MeasuredBatch measureBatch(Device&, const baseline::Chain&, const std::vector<glm::vec3>& targets,
                           const ik::Options&, int repetitions = 5);

}  // namespace skitter::bench

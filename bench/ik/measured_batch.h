#pragma once

#include "base/clock.h"
#include "bench/ik/problem.h"
#include "bench/ik/quality.h"
#include "skitter/device.h"

namespace skitter::bench {

// One batch on the device under options of one's own, judged, then timed.
struct MeasuredBatch {
  Quality quality;
  // Median, least and most of the repetitions of a whole batch: CPU time of all threads on a software device,
  // else wall time.
  double seconds = 0, leastSeconds = 0, mostSeconds = 0;
  double wallSeconds = 0;  // median
};

MeasuredBatch measureBatch(Device&, const baseline::Chain&, const std::vector<glm::vec3>& targets,
                           const ik::Options&, int repetitions = 5);

}  // namespace skitter::bench

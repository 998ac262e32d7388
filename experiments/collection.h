#pragma once

#include <string>
#include <vector>

#include "experiments/course.h"
#include "experiments/page/table.h"
#include "experiments/settings.h"
#include "skitter/device.h"
#include "skitter/heightfield.h"

namespace skitter::experiments {

// Point collection: finding the landing points of n legs, by the dissertation's rule (the point nearest to
// the target wins) and by ours (slope and reach count too).
struct CollectionTime {
  std::string rule;  // "nearest" or "weighed"
  uint32_t legs = 0;
  double deviceMilliseconds = 0, lower = 0,
         upper = 0;              // one dispatch, submitted and waited for: quartiles too
  double inRowMilliseconds = 0;  // a dispatch among many in one submission
  double cpuMilliseconds = 0;    // the CPU crowd's scalar C++, one thread
  double apart = 0;              // metres, between the device's steps and arcs and those of the CPU, median
  double differing = 0;          // share of legs whose step or arc differs by more than a millimetre: ties
};

struct Collection {
  std::vector<CollectionTime> times;

  const CollectionTime* find(const std::string& rule, uint32_t legs) const;
  Table table() const;
};

Collection measureCollection(Device& device, const Heightfield& ground, const Settings& settings,
                             Course& course);

}  // namespace skitter::experiments

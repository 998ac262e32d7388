#pragma once

#include <cstdint>
#include <vector>

#include "experiments/course.h"
#include "experiments/page/table.h"
#include "experiments/settings.h"
#include "skitter/device.h"
#include "skitter/evolve.h"

namespace skitter::experiments {

// How spiders walk that have lost so many legs, over all patterns. Speeds as shares of an intact spider's.
struct LostLegs {
  int legs = 0;
  size_t patterns = 0;
  double kept = 0, keptLeast = 0;  // median and least of the patterns
  double unstable = 0;             // share of time, mean of the patterns
};

// A search for gaits of spiders that have lost legs, and what comes of it (docs/evolve.md).
struct DamageStudy {
  uint64_t evaluations = 0;  // of the search
  double trialSeconds = 0;   // simulated of each
  double searchSeconds = 0;
  uint64_t cells = 0, filled = 0;           // of its map
  std::vector<AdaptationReport> creatures;  // that looked for a gait in it by trial and error
  std::vector<LostLegs> byTable, byRule;    // of the gaits that ship with the spider, and without them

  // Trials that creatures needed until they had 90 % of the best gait known, in ascending order; of those who
  // had it.
  std::vector<uint32_t> trialsNeeded() const;
  Table table() const;
};

DamageStudy measureDamage(Device& device, const Settings& settings, Course& course);

}  // namespace skitter::experiments

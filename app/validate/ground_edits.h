#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "skitter/crowd.h"

namespace skitter::app {

struct HeightEdit {
  uint32_t x, z, columns, rows;
  std::vector<float> heights;
};

// Blocks and pits that come up under the feet of a crowd, for a check of how it takes that. Every four
// seconds a second of it: a few at a time, four times, then time for gait to stop looking at the ground.
class GroundEdits {
 public:
  GroundEdits(const Heightfield& ground, uint64_t seed, double dt);

  // The edits to make before tick n; places are near agents of `herds`, which are the crowd's
  // crowd::allRuns().
  std::vector<HeightEdit> before(uint64_t n, const Crowd& crowd, const std::vector<HerdState>& herds);

 private:
  HeightEdit near(const HerdState& herd, float legLength);
  float drawn(float least, float most);

  Heightfield ground_;  // as it was: an edit is above or below it, so that edits do not pile up
  uint64_t every_;      // ticks
  std::mt19937_64 random_;
};

}  // namespace skitter::app

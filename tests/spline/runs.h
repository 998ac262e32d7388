#pragma once

#include <random>
#include <string>
#include <vector>

#include "cpu_reference/spline/spline.h"
#include "skitter/spline.h"

namespace skitter::test {

// All that a batch is given, and when it is looked at.
struct SplineRun {
  uint64_t seed = 0;
  SplineBatch::Options options;
  uint32_t splines = 0;
  std::vector<glm::vec3> points = {}, arriving = {}, leaving = {};
  std::vector<float> knots = {};  // keys a spline
  std::vector<SplineClock> clocks = {};
  double now = 0;
};

// Points within 2 m of one within 10 m, knots 0.1 to 1.5 apart from a first within +-3, durations 0.3 to 5,
// and clocks that stand anywhere from before the start to beyond the end (closed: the fourth round) at 3600
// s.
SplineRun randomRun(const SplineBatch::Options&, uint32_t splines, uint64_t seed);

reference::SplineRecipe recipeOf(const SplineRun&, uint32_t spline);
SplineChain chainOf(const SplineRun&, uint32_t spline);

SplineBatch batchOf(Device&, const SplineRun&);
std::vector<SplineMotion> travelled(Device&, const SplineRun&);

struct Verdict {
  double worst = 0;  // largest error as a share of what is allowed; above 1 is wrong
  std::string text;  // seed, spline and what was worst
};
Verdict judge(const SplineRun&, const std::vector<SplineMotion>&);

}  // namespace skitter::test

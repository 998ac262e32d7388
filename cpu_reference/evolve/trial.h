#pragma once

#include <vector>

#include "cpu_reference/types.h"

namespace skitter::reference {

// What a trial of a gait has counted so far (docs/evolve.md). Lengths are metres.
struct Trial {
  struct Leg {
    glm::dvec3 tip{0};  // at the last sample, tile-local
    bool planted = false;
    double stood = 0;  // samples
  };
  double samples = 0, distance = 0, cycles = 0, unstable = 0;
  double slip = 0, error = 0, least = 0;
  glm::dvec3 body{0};  // at the last sample, tile-local
  double phase = 0;
  std::vector<Leg> legs = {};
};

// What a trial is judged by.
struct TrialNumbers {
  double legLength = 1, bodyHeight = 0;
  double safe = 0;  // margin below which a sample is unstable
};

struct Sampled {
  Trial trial;
  double margin = 0;  // of this sample
};

// The first sample, which counts nothing.
Trial beginTrial(const AgentBody& body, const Gait& gait, const std::vector<Foot>& feet,
                 const std::vector<Chain>& chains);
// The next one.
Sampled sampleTrial(const TrialNumbers& numbers, const Trial& before, const AgentBody& body, const Gait& gait,
                    const std::vector<Foot>& feet, const std::vector<Chain>& chains);

}  // namespace skitter::reference

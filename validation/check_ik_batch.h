#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "skitter/ik.h"

// A batch of chains held against the reference, chain by chain.
namespace skitter::validation {

// One solve of a batch: what went in and what came out. No chain pauses, or is damped by an earlier solve.
struct IkRun {
  std::string name;  // of chain and solver, for the report
  ik::Chain chain;
  ik::Options options;                // the solver is not `automatic`, the iterations are not 0
  uint64_t seed = 0;                  // of what went in, for the report
  std::vector<glm::vec4> seeds = {};  // Batch::downloadSeeds()
  std::vector<glm::vec4> before =
      {};  // Batch::downloadStates() before the solve; none: every chain began at rest
  std::vector<glm::vec3> targets = {};
  std::vector<glm::vec3> lastTargets = {};  // those of the solve before, which then was the first; or none
  std::vector<ik::Base> bases = {};         // none: all at 0
  std::vector<glm::vec3> joints = {};
  std::vector<ik::Report> reports = {};
};

struct IkParity {
  uint64_t chains = 0;
  uint64_t ties = 0;  // chains for which rounding decides which way the solve goes
  double worst = 0;   // largest difference as a share of its tolerance
  std::string text;   // of that one: quantity, run, seed, chain, joint, difference, tolerance, both values
};

// Joints, error, iterations and stop reason of every chain must be those of the reference, within what
// rounding its input may change them by. Where that alone changes the reference's way, a tie, the batch must
// have come as near to the target as the reference may.
IkParity checkIkBatch(const IkRun& run);

}  // namespace skitter::validation

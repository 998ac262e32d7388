#pragma once

#include "bench/cpu_baseline/batch.h"

namespace skitter::baseline {

// How far a batch's results are from what they claim, worst of all chains; everything in double from the
// joints and poses themselves.
struct Findings {
  double error = 0;       // reported error against target - tip, share of the length
  double length = 0;      // of a bone, share of the chain's
  double joints = 0;      // joints against the forward kinematics of the pose, share of the length
  double limit = 0;       // radians beyond a limit
  size_t wrongStops = 0;  // stops that the error contradicts
  size_t reached = 0, skipped = 0;
  double iterations = 0;  // mean of those not skipped

  // Within what single precision leaves.
  bool hold() const {
    return error < 2e-5 && length < 2e-5 && joints < 5e-5 && limit < 2e-4 && wrongStops == 0;
  }
};

std::string describe(const Findings& findings);

Findings verify(const Chain& chain, const Options& options, const Batch& batch);

}  // namespace skitter::baseline

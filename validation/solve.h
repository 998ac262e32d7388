#pragma once

#include "validation/checks.h"

namespace skitter::validation {

struct SolveVerdict {
  Sample sample;
  bool tie = false;
};

// What a leg was solved to, against what the reference makes of the same foot from `previous`. tails: whether
// a pose that is beyond what some erring solves show is looked for among very many, which takes seconds. It
// need not be once a stage is refused.
SolveVerdict compareSolve(const Setting& setting, const Moment& moment, size_t l, const reference::Limb& limb,
                          const reference::Chain& previous, bool tails);

// A leg that does not carry must be as it was.
Sample compareHeld(const Setting& setting, const Moment& moment, size_t l, const reference::Limb& limb);

// The error of forward kinematics along the limb, a share of the reach.
double kinematicsError(const Setting& setting, const reference::Limb& limb);

}  // namespace skitter::validation

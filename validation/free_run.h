#pragma once

#include <cstddef>
#include <cstdint>

#include "validation/replay.h"

namespace skitter::validation {

// Tick `n` of an agent by the reference alone, but for measure and footfall: every stage reads float records,
// and what it computes is rounded to float, as on a device. HerdState::watched says whether gait looks at the
// ground.
void walkAgent(const Setting& setting, uint64_t n, size_t agent, HerdState& state);

// A herd that the reference walks on its own, to see how far a device's crowd drifts from it. Roundings
// differ, and with them decisions that are close: what is told is a share, and nothing passes or fails by it.
class FreeRun {
 public:
  // From `start`, before tick 1, of a herd that does not avoid or forage. Refers to the herd's terrain, which
  // may be edited between ticks. Throws Error(input) as settingOf does.
  FreeRun(const HerdFacts& herd, HerdState start);
  FreeRun(const FreeRun&) = delete;
  FreeRun& operator=(const FreeRun&) = delete;

  // `watched`: the terrain was edited lately, as HerdState has it.
  void tick(bool watched);
  // Takes over what the host has changed between two ticks, of which `before` and `after` are the device's
  // states: an agent's goal, or all of an agent that was put elsewhere, has come or is gone.
  void follow(const HerdState& before, const HerdState& after);
  // The share of agents that are there whose body and feet are all at most `tolerance` leg lengths from where
  // `device` has them.
  double shareWithin(const HerdState& device, double tolerance) const;

 private:
  Setting setting_;
  HerdState state_;
};

}  // namespace skitter::validation

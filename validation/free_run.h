#pragma once

#include "validation/replay.h"

namespace skitter::validation {

// Tick `n` of an adaptive agent by the reference alone, but for measure: every stage reads float records, and
// what it computes is rounded to float, as on a device.
void walkAgent(const Setting& setting, uint64_t n, size_t agent, HerdState& state);

// An adaptive herd that the reference walks on its own, to see how far a device's crowd drifts from it.
// Roundings differ, and with them decisions that are close: what is told is a share, and nothing passes or
// fails by it.
class FreeRun {
 public:
  // From `start`, before tick 1. Throws Error(input) for another controller.
  FreeRun(const HerdFacts& herd, HerdState start);
  FreeRun(const FreeRun&) = delete;
  FreeRun& operator=(const FreeRun&) = delete;

  void tick();
  // Of the agents, those whose body and feet all are at most `tolerance` leg lengths from where `device` has
  // them.
  double shareWithin(const HerdState& device, double tolerance) const;

 private:
  Heightfield terrain_;
  Setting setting_;
  HerdState state_;
};

}  // namespace skitter::validation

#pragma once

#include "skitter/crowd.h"
#include "spider.h"
#include "validation/replay.h"

namespace skitter::test {

// A herd that the reference itself walks: every stage reads float records and its results are rounded to
// float, as on a device.
class ReferenceHerd {
 public:
  ReferenceHerd(const Heightfield& terrain, uint32_t agents, int padding = 0);

  void tick();
  uint64_t ticks() const { return state_.tick; }
  const HerdState& state() const { return state_; }
  HerdState& state() { return state_; }
  const shared::Parameters& parameters() const { return parameters_; }
  shared::Parameters& parameters() { return parameters_; }
  int legs() const { return rig_.legCount(); }
  int bones() const { return bones_; }
  validation::HerdFacts facts() const;
  validation::Replay replay() const;

  static constexpr reference::IkPlan plan = {reference::IkSolver::fabrik, 1, 2};

 private:
  void spawn(uint32_t agents);
  void tickAgent(size_t agent);

  Rig rig_;
  Heightfield terrain_;
  shared::Parameters parameters_;
  std::vector<float> rigRecords_;
  int bones_;
  HerdState state_;
};

}  // namespace skitter::test

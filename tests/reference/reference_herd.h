#pragma once

#include "cpu_reference/stages/adapt.h"
#include "crowd/gait_map.h"
#include "skitter/crowd.h"
#include "spider.h"
#include "validation/replay.h"

namespace skitter::test {

// A herd that the reference itself walks: every stage reads float records and its results are rounded to
// float, as on a device.
class ReferenceHerd {
 public:
  ReferenceHerd(const Heightfield& terrain, uint32_t agents, int padding = 0);

  // From the next tick on its agents can be hurt, and adapt with the gaits of that map.
  void adapt(const reference::GaitMap& map);

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
  void make(Record record);
  void spawn(uint32_t agents);
  void tickAgent(size_t agent);

  Rig rig_;
  Heightfield terrain_;
  shared::Parameters parameters_;
  std::vector<float> rigRecords_;
  crowd::GaitMap gaitMap_;
  int bones_;
  HerdState state_;
};

}  // namespace skitter::test

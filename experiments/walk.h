#pragma once

#include <vector>

#include "base/clock.h"
#include "experiments/agents.h"
#include "gpu/submit.h"
#include "skitter/crowd.h"

namespace skitter::experiments {

// A crowd of one herd that is walked tick by tick.
class Walk {
 public:
  Walk(Device& device, const Heightfield& ground, const Scene& scene, double dt,
       const CrowdOptions& options = {})
      : crowd_(device, ground, scene, options), ring_(device.context()), dt_(static_cast<float>(dt)) {}

  // One tick to its end, on the host's clocks.
  base::Seconds tick() {
    return base::timed([&] {
      crowd_.record(ring_.begin(), dt_);
      ring_.wait(ring_.submit());
    });
  }
  void ticks(uint32_t count) {
    for (uint32_t i = 0; i < count; ++i) tick();
  }
  std::vector<AgentState> agents() const { return agentsOf(crowd_.download(0), rig()); }

  Crowd& crowd() { return crowd_; }
  const Rig& rig() const { return crowd_.rig(0); }
  gpu::CommandRing& ring() { return ring_; }
  float dt() const { return dt_; }

 private:
  Crowd crowd_;
  gpu::CommandRing ring_;
  float dt_;
};

}  // namespace skitter::experiments

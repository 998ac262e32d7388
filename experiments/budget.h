#pragma once

#include <string>
#include <vector>

#include "experiments/course.h"
#include "experiments/page/table.h"
#include "experiments/settings.h"
#include "skitter/controller.h"
#include "skitter/device.h"
#include "skitter/heightfield.h"

namespace skitter::experiments {

// Figures 6 to 8: what a tick costs with how many agents, and how many there may be before a budget is
// passed.

// One crowd timed: each tick is recorded, submitted and waited for by itself.
struct TickCost {
  Controller controller;
  bool drawn = false;  // a picture of it too, in the time
  uint32_t agents = 0;
  uint64_t inView = 0;                            // agents, in the last frame that was drawn
  double milliseconds = 0, lower = 0, upper = 0;  // median and quartiles, wall clock
  double cpuMilliseconds = 0;                     // median, all threads of the process
};

// The most agents whose median stays within a budget.
struct AgentLimit {
  Controller controller;
  bool drawn = false;
  double budget = 0;            // milliseconds
  uint32_t agents = 0;          // were within; 0: not even one was
  uint32_t next = 0;            // agents, the fewest that were not; 0: as many as were tried were within
  double lower = 0, upper = 0;  // agents: where the quartiles of `agents` and `next` cross the budget
  // Agents whose CPU time fits the budget if every thread of the machine were free: what a software device
  // would do on a machine of its own. Not of other devices: 0.
  double byCpu = 0;
  uint64_t inView = 0;  // of `agents`, where frames are drawn
};

struct Budget {
  FrameSize frame;  // where frames are drawn
  std::vector<TickCost> costs;
  std::vector<AgentLimit> limits;

  const AgentLimit* limit(Controller controller, bool drawn, double budget) const;
  Table costTable() const;
  Table limitTable() const;
};

// Doubles the agents until the median passes each budget, then halves the bracket until it is as narrow as
// the settings ask for.
Budget measureBudget(Device& device, const Heightfield& ground, const Settings& settings, bool drawn,
                     Course& course);

}  // namespace skitter::experiments

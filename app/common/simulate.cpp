#include "app/common/simulate.h"

#include "base/clock.h"

namespace skitter::app {

void addStages(std::vector<StageTime>& sums, const std::vector<StageTime>& times) {
  if (sums.empty()) {
    sums = times;
    return;
  }
  for (size_t s = 0; s < sums.size() && s < times.size(); ++s) sums[s].milliseconds += times[s].milliseconds;
}

void runTick(gpu::CommandRing& ring, Crowd& crowd, float dt, TickTimes& times) {
  const base::Seconds spent = base::timed([&] {
    crowd.record(ring.begin(), dt);
    ring.wait(ring.submit());
  });
  times.cpuSeconds += spent.cpu;
  times.milliseconds.push_back(1e3 * spent.wall);
  addStages(times.stages, crowd.stageTimes());
}

}  // namespace skitter::app

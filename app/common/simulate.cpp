#include "app/common/simulate.h"

#include <algorithm>

#include "base/clock.h"
#include "crowd/herd.h"
#include "skitter/renderer.h"

namespace skitter::app {

void addStages(std::vector<StageTime>& sums, const std::vector<StageTime>& times) {
  // By name: with the herds that are there, the stages change.
  for (const StageTime& time : times) {
    const auto same = std::ranges::find(sums, time.stage, &StageTime::stage);
    if (same == sums.end())
      sums.push_back(time);
    else
      same->milliseconds += time.milliseconds;
  }
}

void lookAt(const Scene& scene, Crowd& crowd, double dt) {
  if (implOf(crowd).rates)
    crowd.lookFrom(viewOf(scene, crowd, static_cast<double>(crowd.tick() + 1) * dt).eye);
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

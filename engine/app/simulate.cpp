#include "simulate.h"

#include <chrono>

#include "clock.h"

namespace skitter::app {
namespace {

void addStages(std::vector<StageTime>& sums, const std::vector<StageTime>& times) {
  if (sums.empty()) {
    sums = times;
    return;
  }
  for (size_t s = 0; s < sums.size() && s < times.size(); ++s) sums[s].milliseconds += times[s].milliseconds;
}

}  // namespace

void runTick(gpu::CommandRing& ring, Crowd& crowd, float dt, TickTimes& times) {
  const double cpuBefore = processSeconds();
  const auto before = std::chrono::steady_clock::now();
  crowd.record(ring.begin(), dt);
  ring.wait(ring.submit());
  const auto after = std::chrono::steady_clock::now();
  times.cpuSeconds += processSeconds() - cpuBefore;
  times.milliseconds.push_back(std::chrono::duration<double, std::milli>(after - before).count());
  addStages(times.stages, crowd.stageTimes());
}

}  // namespace skitter::app

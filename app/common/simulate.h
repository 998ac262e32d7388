#pragma once

#include <cstdint>
#include <vector>

#include "gpu/submit.h"
#include "skitter/crowd.h"
#include "skitter/scene.h"

namespace skitter::app {

// What the ticks of a run took on the host's clocks. Each is recorded, submitted and waited for by itself, so
// that nothing else is in the figure.
struct TickTimes {
  std::vector<double> milliseconds;  // wall, tick by tick
  double cpuSeconds = 0;             // of all threads of the process, over all ticks
  std::vector<StageTime> stages;     // sums over all ticks, on the device's clock; empty without timestamps
};

// Adds what one tick or picture took, stage by stage, to the sums of those before it.
void addStages(std::vector<StageTime>& sums, const std::vector<StageTime>& times);

// Where there are levels of rate, they go by the scene's camera as it is after the next tick.
void lookAt(const Scene& scene, Crowd& crowd, double dt);

// Runs one tick to its end and adds its times.
void runTick(gpu::CommandRing& ring, Crowd& crowd, float dt, TickTimes& times);

}  // namespace skitter::app

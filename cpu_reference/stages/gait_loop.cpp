#include "cpu_reference/stages/gait_loop.h"

#include "cpu_reference/stages/gait.h"

namespace skitter::reference {

LoopGaitResult loopGait(const Tuning& tuning, int groups, const AgentBody& body, double phase,
                        const std::optional<double>& duration, double slowest) {
  const Stride stride = strideOf(tuning, groups, body, duration, slowest);
  if (!(body.still > 0)) {
    phase += tuning.dt / stride.cycle;
    phase -= std::floor(phase);
  }
  LoopGaitResult result;
  result.gait.phase = phase;
  result.gait.duration = stride.duration;
  result.gait.halfStride = stride.half;
  result.gait.cycle = stride.cycle;
  result.durationMargin = stride.durationMargin;
  return result;
}

}  // namespace skitter::reference

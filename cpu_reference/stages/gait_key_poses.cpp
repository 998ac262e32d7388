#include "cpu_reference/stages/gait_key_poses.h"

namespace skitter::reference {

double wheelPhase(const Tuning& tuning, double stride, const AgentBody& body, double phase) {
  const double way = body.pace(tuning) * tuning.dt;
  const double turned = phase + way / stride;
  return turned - std::floor(turned);
}

}  // namespace skitter::reference

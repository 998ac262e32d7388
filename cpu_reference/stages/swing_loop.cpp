#include "cpu_reference/stages/swing_loop.h"

#include "cpu_reference/stages/swing.h"

namespace skitter::reference {

LoopFoot loopSwing(const Tuning& tuning, int groups, const Limb& limb, const AgentBody& body,
                   const Gait& gait) {
  LoopFoot result;
  const double swingTime = limb.stepTicks(gait.duration) * tuning.dt, stanceTime = gait.cycle - swingTime;
  result.theta = gait.phase + limb.group / groups;
  result.theta -= std::floor(result.theta);
  const double time = result.theta * gait.cycle;
  result.flown = (time - stanceTime) / swingTime;

  // Where a foot is on the ground `seconds` before it passes its home, seen from the body.
  const auto stance = [&](double seconds) {
    return Turn(body.turnRate * seconds)(limb.home) + glm::dvec3(0, 0, body.surfaceSpeed * seconds);
  };
  glm::dvec3 inModel;
  if (result.flown < 0) {
    inModel = stance(stanceTime / 2 - time);
  } else {
    Step step;
    step.liftOff = stance(-stanceTime / 2);
    step.landing = stance(stanceTime / 2);
    const double height = tuning.stepHeight * std::min(1.0, body.pace(tuning) / (0.1 * tuning.legLength));
    step.lift = step.startTangent = {0, height, 0};
    inModel = splineAt(step, result.flown).position;
    result.foot.progress = std::min(result.flown, 0.999);
  }
  result.foot.target = body.orientation * inModel;
  return result;
}

}  // namespace skitter::reference

#include "cpu_reference/ik.h"

#include <algorithm>

#include "cpu_reference/active_set.h"
#include "cpu_reference/ccd.h"
#include "cpu_reference/deadlock.h"
#include "cpu_reference/fabrik.h"
#include "cpu_reference/jacobian.h"

namespace skitter::reference {
namespace {

void iterate(IkSolver solver, const glm::dvec3& target, Posture& posture) {
  if (solver == IkSolver::fabrik) return fabrik(target, posture);
  if (solver == IkSolver::ccd) return ccd(target, posture);
  jacobian(methodOf(solver), target, posture);
}

// While the tip is further than `enough` from the target. The best pose seen is kept; of those whose errors
// are no more than `tie` apart the last.
void approach(const IkPlan& plan, double enough, double tie, const glm::dvec3& target, Posture& posture) {
  Pose best = posture.pose();
  double bestError = glm::length(target - posture.tip()), error = bestError;
  for (int iteration = 0; iteration < plan.approachIterations && error > enough; ++iteration) {
    iterate(plan.approach, target, posture);
    error = glm::length(target - posture.tip());
    if (error < bestError + tie) {
      bestError = std::min(bestError, error);
      best = posture.pose();
    }
  }
  posture.setPose(best);
}

// The rest pull moves the tip, and a chord step makes good for that.
void polish(const Tuning& tuning, int chords, const glm::dvec3& target, Posture& posture) {
  const ActiveSet how{chords > 0 ? tuning.restPull : 0, tuning.pullError, tuning.ikTolerance, chords};
  // If the step leads away, a short one in its place.
  for (const double damping : {1.0, 256.0}) {
    double next = damping;
    activeSet(how, target, posture, next);
    if (next <= damping) return;
  }
}

}  // namespace

glm::dvec3 ikTarget(const Limb& limb, const AgentBody& body, const glm::dvec3& foot) {
  return (glm::conjugate(body.orientation) * foot - limb.root) / limb.reach;
}

Chain ik(const Tuning& tuning, const Limb& limb, const AgentBody& body, const Foot& foot,
         const Chain& previous, const IkPlan& plan, double approachTie) {
  Chain chain = previous;
  Posture posture(limb, previous.directions);
  glm::dvec3 target = ikTarget(limb, body, foot.target);
  const bool finite = glm::dot(target, target) < 1e38;  // nor absurdly far away
  if (!finite) target = posture.tip();
  if (finite) {
    breakDeadlock(target, posture);
    approach(plan, tuning.approachError, approachTie, target, posture);
    if (plan.polishIterations > 0) polish(tuning, plan.polishIterations - 1, target, posture);
  }
  chain.directions = posture.directions();
  chain.tip = body.orientation * (limb.root + limb.reach * posture.tip());
  const double error = glm::length(target - posture.tip());
  chain.reachError = error * limb.reach;
  chain.miss = foot.progress >= 1 && error > tuning.missLeast ? error : 0;
  return chain;
}

}  // namespace skitter::reference

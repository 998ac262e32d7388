#include "cpu_reference/stages/ik.h"

#include <algorithm>

#include "cpu_reference/ik/active_set.h"
#include "cpu_reference/ik/ccd.h"
#include "cpu_reference/ik/deadlock.h"
#include "cpu_reference/ik/fabrik.h"
#include "cpu_reference/ik/jacobian.h"

namespace skitter::reference {
namespace {

void iterate(IkSolver solver, const glm::dvec3& target, Posture& posture, Arithmetic& arithmetic) {
  if (solver == IkSolver::fabrik) return fabrik(target, posture, arithmetic);
  if (solver == IkSolver::ccd) return ccd(target, posture, arithmetic);
  jacobian(methodOf(solver), target, posture, arithmetic);
}

// While the tip is further than `enough` from the target. The best pose seen is kept.
void approach(const IkPlan& plan, double enough, const glm::dvec3& target, Posture& posture,
              Arithmetic& arithmetic) {
  const auto errorNow = [&] { return arithmetic.length(target - posture.tip() + arithmetic.placeErrors()); };
  Pose best = posture.pose();
  double bestError = errorNow(), error = bestError;
  for (int k = 0; k < plan.approachIterations && arithmetic.below(enough, error); ++k) {
    iterate(plan.approach, target + arithmetic.placeErrors(), posture, arithmetic);
    error = errorNow();
    if (!arithmetic.below(error, bestError)) continue;
    bestError = error;
    best = posture.pose();
  }
  posture.setPose(best);
}

// The rest pull moves the tip, and a chord step makes good for that.
void polish(const Tuning& tuning, int chords, const glm::dvec3& target, Posture& posture,
            Arithmetic& arithmetic) {
  const ActiveSet how{chords > 0 ? tuning.restPull : 0, tuning.pullError, tuning.ikTolerance, chords};
  // If the step leads away, a short one in its place.
  for (const double damping : {1.0, 256.0}) {
    double next = damping;
    activeSet(how, target, posture, next, arithmetic);
    if (next <= damping) return;
  }
}

}  // namespace

glm::dvec3 ikTarget(const Limb& limb, const AgentBody& body, const glm::dvec3& foot) {
  return (glm::conjugate(body.orientation) * foot - limb.root) / limb.reach;
}

Chain ik(const Tuning& tuning, const Limb& limb, const AgentBody& body, const Foot& foot,
         const Chain& previous, const IkPlan& plan) {
  Arithmetic exact;
  return ik(tuning, limb, body, foot, previous, plan, exact);
}

Chain ik(const Tuning& tuning, const Limb& limb, const AgentBody& body, const Foot& foot,
         const Chain& previous, const IkPlan& plan, Arithmetic& arithmetic) {
  Chain chain = previous;
  Posture posture(limb, previous.directions);
  glm::dvec3 target = ikTarget(limb, body, foot.target);
  const bool finite = glm::dot(target, target) < 1e38;  // nor absurdly far away
  if (!finite) target = posture.tip();
  if (finite) {
    const glm::dvec3 aim = target + arithmetic.targetErrors();
    breakDeadlock(aim, posture, arithmetic);
    approach(plan, tuning.approachError, aim, posture, arithmetic);
    for (int round = 0; plan.polishIterations > 0 && round < plan.rounds; ++round)
      polish(tuning, plan.polishIterations - 1, aim, posture, arithmetic);
  }
  chain.directions = posture.directions();
  chain.tip = body.orientation * (limb.root + limb.reach * posture.tip());
  const double error = glm::length(target - posture.tip());
  chain.reachError = error * limb.reach;
  chain.miss = foot.progress >= 1 && error > tuning.missLeast ? error : 0;
  return chain;
}

}  // namespace skitter::reference

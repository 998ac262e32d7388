#pragma once

#include "cpu_reference/arithmetic.h"
#include "cpu_reference/ik/solve.h"
#include "cpu_reference/types.h"

namespace skitter::reference {

// What a tick does: the approach's solver with its iterations, at most, while the error is above
// approachError; then active-set steps, each with chord steps.
struct IkPlan {
  IkSolver approach = IkSolver::fabrik;  // or ccd, transpose, pseudoinverse, dls, targetAttached
  int approachIterations = 0, polishIterations = 0;
  int rounds = 1;  // of the active-set step with its chord steps
};

// `previous` gives the warm start. A target that is not finite keeps the pose and counts as
// reached. Its decisions are those of breakDeadlock; of each approach iteration, whether it is needed and
// whether it is the best so far; and those of each active-set step.
Chain ik(const Tuning& tuning, const Limb& limb, const AgentBody& body, const Foot& foot,
         const Chain& previous, const IkPlan& plan);
Chain ik(const Tuning& tuning, const Limb& limb, const AgentBody& body, const Foot& foot,
         const Chain& previous, const IkPlan& plan, Arithmetic& arithmetic);

// The target in the limb's own terms: model space with the root at 0, divided by the reach.
glm::dvec3 ikTarget(const Limb& limb, const AgentBody& body, const glm::dvec3& foot);

}  // namespace skitter::reference

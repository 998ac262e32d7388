#pragma once

#include "cpu_reference/ik_solve.h"
#include "cpu_reference/types.h"

namespace skitter::reference {

// What a tick does: the approach's solver with its iterations, at most, while the error is above
// approachError; then one active-set step with chord steps.
struct IkPlan {
  IkSolver approach = IkSolver::fabrik;  // or ccd, transpose, pseudoinverse, dls, targetAttached
  int approachIterations = 0, polishIterations = 0;
};

// `previous` gives the warm start. A target that is not finite keeps the pose and counts as
// reached. Of approach iterations whose errors are no more than `approachTie` reaches apart the last is kept,
// without it the best.
Chain ik(const Tuning& tuning, const Limb& limb, const AgentBody& body, const Foot& foot,
         const Chain& previous, const IkPlan& plan, double approachTie = 0);

// The target in the limb's own terms: model space with the root at 0, divided by the reach.
glm::dvec3 ikTarget(const Limb& limb, const AgentBody& body, const glm::dvec3& foot);

}  // namespace skitter::reference

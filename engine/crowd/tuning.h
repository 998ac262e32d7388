#pragma once

#include "shared/parameters.h"
#include "skitter/heightfield.h"
#include "skitter/rig.h"
#include "skitter/solver.h"
#include "skitter/tuning.h"

namespace skitter::crowd {

// What the ik stage does a tick; docs/stages/ik.md says what each buys.
struct IkPlan {
  int solver;    // shared::SOLVER_, of the approach
  int approach;  // its iterations, at most
  int polish;    // the active set's step and chord steps
};
// Throws Error(input) where the solver is none of herdSolvers.
IkPlan ikPlanFor(Solver);

// Scaled to the rig, for ticks of `dt` seconds on this terrain.
shared::Parameters tuningFor(const Tuning& tuning, const Rig& rig, const IkPlan& ik,
                             const Heightfield& terrain, float dt);

}  // namespace skitter::crowd

#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/arcs.h"
#include "experiments/budget.h"
#include "experiments/collection.h"
#include "experiments/damage.h"
#include "experiments/fidelity.h"
#include "experiments/gait.h"
#include "experiments/iteration.h"
#include "experiments/ladder.h"
#include "experiments/placement.h"

namespace skitter::experiments {

// Everything that the dissertation shows, measured again.
struct Results {
  FabrikIteration iteration;              // Figure 1
  Ladder ladder;                          // Figure 2
  std::vector<bench::SolveSweep> sweeps;  // Figures 3 to 5
  std::vector<bench::InstancePoint> instances;
  Budget simulated, drawn;  // Figures 6 to 8
  Collection collection;
  std::vector<FootArcs> arcs;               // Figures 9 to 11
  std::vector<PlacementPicture> placement;  // Figures 12 to 14
  FidelityStudy fidelity;
  GaitStudy gait;
  DamageStudy damage;  // beyond the dissertation
};

// In the order of the struct, but for the times: they come first, before the machine is warm with pictures.
// Throws Interrupted, and whatever the engine throws.
Results measureAll(Device& device, const std::vector<Ground>& grounds, const Settings& settings,
                   Course& course);

}  // namespace skitter::experiments

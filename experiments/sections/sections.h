#pragma once

#include "experiments/report.h"

// The sections of the page: each shows what one experiment measured, and files its raw figures.
namespace skitter::experiments {

void showConclusions(const std::vector<Conclusion>& conclusions, Report& report);
void showSetup(const Setup& setup, Report& report);
void showIteration(const FabrikIteration& iteration, Report& report);
void showLadder(const Ladder& ladder, Report& report);
void showSolves(const std::vector<bench::SolveSweep>& sweeps,
                const std::vector<bench::InstancePoint>& instances, const Settings& settings, Report& report);
void showBudget(const Budget& simulated, const Budget& drawn, const Settings& settings, Report& report);
void showCollection(const Collection& collection, const Settings& settings, Report& report);
void showArcs(const std::vector<FootArcs>& arcs, Report& report);
void showPlacement(const std::vector<PlacementPicture>& pictures, Report& report);
void showFidelity(const FidelityStudy& study, const Settings& settings, Report& report);
void showGait(const GaitStudy& study, Report& report);
void showDamage(const DamageStudy& study, const Settings& settings, Report& report);

}  // namespace skitter::experiments

#include "experiments/report.h"

#include "experiments/sections/sections.h"

namespace skitter::experiments {

std::vector<ReportFile> reportOf(const Results& results, const Settings& settings, const Setup& setup) {
  Report report{
      Page("The dissertation, measured again",
           "Every figure of \"The use of Procedural Adaptive Animation to increase Visual Fidelity\", "
           "repeated with Skitter on one machine in one run."),
      {}};
  showConclusions(conclusionsOf(results), report);
  showSetup(setup, report);
  showIteration(results.iteration, report);
  showLadder(results.ladder, report);
  showSolves(results.sweeps, results.instances, settings, report);
  showBudget(results.simulated, results.drawn, settings, report);
  showCollection(results.collection, settings, report);
  showArcs(results.arcs, report);
  showPlacement(results.placement, report);
  showFidelity(results.fidelity, settings, report);
  showGait(results.gait, report);
  showDamage(results.damage, settings, report);
  report.files.push_back({"index.html", report.page.html()});
  return std::move(report.files);
}

}  // namespace skitter::experiments

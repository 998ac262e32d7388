#include "experiments/results.h"

namespace skitter::experiments {

Results measureAll(Device& device, const std::vector<Ground>& grounds, const Settings& settings,
                   Course& course) {
  const Heightfield rolling = rollingGround(), steep = steepGround();
  Results made;
  made.iteration = measureIteration();
  // Shares of the time that it takes on a software device.
  course.begin(0.16);
  const auto solving = [&](double from, double share) {
    return [&course, from, share](double done) { course.at(from + share * done); };
  };
  made.sweeps = bench::measureSweeps(device, settings.solves, solving(0, 0.6));
  made.instances = bench::measureInstances(device, settings.solves, solving(0.6, 0.4));
  course.begin(0.25);
  made.simulated = measureBudget(device, rolling, settings, false, course);
  course.begin(0.15);
  made.drawn = measureBudget(device, rolling, settings, true, course);
  course.begin(0.04);
  made.collection = measureCollection(device, rolling, settings, course);
  course.begin(0.02);
  made.ladder = measureLadder(device, steep, settings, course);
  course.begin(0.03);
  made.arcs = measureArcs(device, rolling, settings, course);
  course.begin(0.05);
  made.placement = measurePlacement(device, steep, settings, course);
  course.begin(0.12);
  made.fidelity = measureFidelity(device, grounds, settings, course);
  course.begin(0.08);
  made.gait = measureGait(device, settings, course);
  course.begin(0.10);
  made.damage = measureDamage(device, settings, course);
  course.at(1);
  return made;
}

}  // namespace skitter::experiments

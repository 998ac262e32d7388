#pragma once

#include <string>
#include <vector>

#include "experiments/agents.h"
#include "experiments/course.h"
#include "experiments/page/table.h"
#include "experiments/settings.h"
#include "skitter/controller.h"
#include "skitter/device.h"

namespace skitter::experiments {

// Figures 9 to 11: where the feet of one walking agent are, tick by tick, over two cycles of its first leg.
struct FootArcs {
  Controller controller;
  std::vector<std::string> legs;  // names
  std::vector<AgentState> ticks;
  std::vector<std::vector<double>> ground;  // [tick][leg] height below the foot
  double legLength = 1;

  double depth() const;   // mean penetration, all feet, leg lengths
  double height() const;  // mean float of feet in stance, leg lengths
};

std::vector<FootArcs> measureArcs(Device& device, const Heightfield& ground, const Settings& settings,
                                  Course& course);
Table tableOf(const std::vector<FootArcs>& arcs);

}  // namespace skitter::experiments

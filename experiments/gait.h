#pragma once

#include <string>
#include <vector>

#include "experiments/course.h"
#include "experiments/page/table.h"
#include "experiments/settings.h"
#include "skitter/controller.h"
#include "skitter/device.h"

namespace skitter::experiments {

// How agents walk on level ground, in the terms in which biologists measure spiders. Lengths in leg lengths,
// times in seconds, phases in cycles.
struct GaitRow {
  Controller controller;
  double commanded = 0, speed = 0;  // a second
  double duty = 0;                  // stance share of all legs and ticks
  double frequency = 0;             // cycles a second; 0: no leg made a whole cycle
  double stride = 0;                // length: speed / frequency
  double bounce = 0;                // of the body: highest less lowest, mean of the agents
  double cycles = 0;                // that the phases are means of
  std::vector<double> phases;       // when each leg lifts, after the first leg; empty without cycles
  std::vector<double> steadiness;   // 1: always at that phase, 0: at any
  double lag = 0;                   // widest between two legs of one group, mean of the groups
  double groupsApart = 0;           // between the first two groups
};

struct GaitStudy {
  std::vector<std::string> legs;  // names
  std::vector<int> groups;        // of each leg
  std::vector<GaitRow> rows;
  // One adaptive agent at a leg length a second: stance of each leg, tick by tick.
  std::vector<std::vector<bool>> footfalls;
  double dt = 0;

  const GaitRow* find(Controller controller, double commanded) const;
  // The order in which the legs of a side lift, from the hindmost on, as a biologist writes it: "4-2-3-1";
  // '=' between legs that lift within 0.02 of a cycle.
  std::string order(const GaitRow& row, char side) const;
  // Slope and r of duty against speed, over the rows of a controller that walk.
  struct Line {
    double slope = 0, correlation = 0;
    int points = 0;
  };
  Line dutyLine(Controller controller) const;
  Table table() const;
};

GaitStudy measureGait(Device& device, const Settings& settings, Course& course);

}  // namespace skitter::experiments

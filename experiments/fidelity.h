#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/course.h"
#include "experiments/grounds.h"
#include "experiments/page/table.h"
#include "experiments/settings.h"
#include "skitter/controller.h"
#include "skitter/crowd.h"

namespace skitter::experiments {

// A figure of Fidelity as a column: what it is called, in which unit it is shown.
struct FidelityColumn {
  const char* name;  // of the CSV file
  const char* title;
  double scale;
  std::function<std::optional<double>(const Fidelity&)> value;  // none: not judged for this controller
};
const std::vector<FidelityColumn>& fidelityColumns();

// How one controller did on one ground.
struct FidelityRow {
  std::string ground;
  Controller controller;
  double roughness = 0;  // under the agents, leg lengths: rms residual from the plane under the feet, mean
  double speed = 0;      // achieved, share of the commanded
  // Seen from outside, by the places of the feet at every look: all feet below the ground, feet in stance
  // above it, means in leg lengths. They stand beside what the device measures of itself, whatever that
  // counts.
  double depthSeen = 0, heightSeen = 0;
  Fidelity fidelity;
};

struct FidelityStudy {
  std::vector<FidelityRow> rows;
  std::vector<std::string> grounds;  // name and origin of each

  const FidelityRow* find(const std::string& ground, Controller controller) const;
  Table csv() const;
};

FidelityStudy measureFidelity(Device& device, const std::vector<Ground>& grounds, const Settings& settings,
                              Course& course);

}  // namespace skitter::experiments

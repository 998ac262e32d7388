#pragma once

#include <vector>

#include "cpu_reference/types.h"

namespace skitter::reference {

// The field of a goal, as stage navigate goes by it (docs/ways.md).
struct WayField {
  glm::dvec2 goal{0}, stop{0};
  size_t columns = 0, rows = 0;
  double cell = 0;
  glm::dvec2 origin{0};
  std::vector<double> cost = {};   // of the cells
  std::vector<double> times = {};  // at the middles of the cells
};

// A decision taken instead of the rule.
struct WayChoices {
  int straight = -1;      // 0 or 1: forced
  int stops = -1;         // 0 or 1: forced
  glm::ivec2 besides{0};  // the four middles this far from those around the place
};

struct WayResult {
  bool straight = false;  // as without a field, to the stop
  glm::dvec2 desired{0};  // else
  // Distances to the decisions: of the distance to the stop, metres; of the time from the arrival radius; of
  // the place from the lines through the middles of cells on either side, cells.
  double straightMargin = 0, stopMargin = 0;
  glm::dvec2 lowerMargin{0}, upperMargin{0};
  double away = 0;  // metres to the stop
  // What errors follow from: how much the direction changes with the place, for each cell; the largest
  // difference of the times around, as a share of the gradient's length and in itself.
  double turning = 0, magnified = 0, rise = 0;
};
WayResult followWay(const Tuning& tuning, const WayField& way, const glm::dvec2& position, double speed,
                    double arrivalRadius, const WayChoices& choices = {});

}  // namespace skitter::reference

#pragma once

#include <cstdint>
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

// A place of goals in series, and which come next: `choices` of them from the first on.
struct WayPlace {
  glm::dvec2 at{0};
  size_t first = 0, choices = 0;
};
// The number of the place that an agent goes to after `place`, and its draw, which was `draw`.
struct WayNext {
  size_t number = 0;
  uint32_t draw = 0;
};
WayNext wayNext(const WayPlace& place, uint32_t draw);

// A decision taken instead of the rule.
struct WayChoices {
  int straight = -1;      // 0 or 1: forced
  int stops = -1;         // 0 or 1: forced
  int passes = -1;        // 0 or 1: forced
  glm::ivec2 besides{0};  // the four middles this far from those around the place
};

struct WayResult {
  bool straight = false;  // as without a field, to the stop
  bool passes = false;    // a place of a series is behind the agent
  glm::dvec2 desired{0};  // else
  // Distances to the decisions: of the distance to the stop, metres; of the time from the arrival radius, and
  // from the one at which a place is passed; of the place from the lines through the middles of cells on
  // either side, cells.
  double straightMargin = 0, stopMargin = 0, passMargin = 0;
  glm::dvec2 lowerMargin{0}, upperMargin{0};
  double away = 0;  // metres to the stop
  // Errors follow from these: how much the direction changes with the place, for each cell; the largest
  // difference of the times around, beside an obstacle more by the latest of these, as a share of the
  // gradient's length; that difference in itself.
  double turning = 0, magnified = 0, rise = 0;
};
WayResult followWay(const Tuning& tuning, const WayField& way, const glm::dvec2& position, double speed,
                    double arrivalRadius, const WayChoices& choices = {});

}  // namespace skitter::reference

#include <algorithm>
#include <cmath>

#include "cpu_reference/stages/tolerances.h"
#include "cpu_reference/ways/grid.h"
#include "shared/ways.h"
#include "validation/checks.h"

namespace skitter::validation {

Sample compareWay(const reference::WayField& field) {
  reference::WayGrid grid;
  grid.columns = field.columns;
  grid.rows = field.rows;
  grid.cell = field.cell;
  grid.origin = field.origin;
  grid.cost = field.cost;
  const std::vector<double> expected =
      reference::wayTimes(grid, reference::wayStarts(grid, field.goal), double{shared::WAY_INSIDE_COST});
  Sample sample;
  for (size_t at = 0; at < expected.size(); ++at) {
    // Nothing leads from there to a stop.
    if (std::isinf(expected[at]) && field.times[at] == double{shared::WAY_FAR}) continue;
    sample.compare("time of a field", std::abs(field.times[at] - expected[at]),
                   reference::tolerance::wayField * std::max(expected[at], field.cell),
                   {expected[at], grid.middle(at), 0}, {field.times[at], grid.middle(at), 0});
  }
  return sample;
}

}  // namespace skitter::validation

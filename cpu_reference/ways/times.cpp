#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "cpu_reference/ways/grid.h"

namespace skitter::reference {
namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();

// Cells are accepted by time, earliest first; a time follows from those accepted beside it.
class Marching {
 public:
  Marching(const WayGrid& grid, double insideCost)
      : grid_(grid), insideCost_(insideCost), times_(grid.cells(), unknown), accepted_(grid.cells(), false) {}

  void start(const WayStart& at) {
    if (at.time < times_[at.cell]) front_.emplace(times_[at.cell] = at.time, at.cell);
  }
  // Over passable cells or the others; of the latter, from all that are accepted.
  void march(bool inside) {
    if (inside)
      for (size_t at = 0; at < grid_.cells(); ++at)
        if (accepted_[at]) tryBeside(at, inside);
    while (!front_.empty()) {
      const auto [time, at] = front_.top();
      front_.pop();
      if (accepted_[at]) continue;
      accepted_[at] = true;
      tryBeside(at, inside);
    }
  }
  std::vector<double> take() { return std::move(times_); }

 private:
  double acceptedAt(size_t at) const { return accepted_[at] ? times_[at] : unknown; }

  void tryBeside(size_t at, bool inside) {
    const size_t column = at % grid_.columns, row = at / grid_.columns;
    if (column > 0) tryCell(at - 1, inside);
    if (column + 1 < grid_.columns) tryCell(at + 1, inside);
    if (row > 0) tryCell(at - grid_.columns, inside);
    if (row + 1 < grid_.rows) tryCell(at + grid_.columns, inside);
  }

  // Rouy and Tourin 1992: (T - a)+^2 + (T - b)+^2 = h^2.
  void tryCell(size_t at, bool inside) {
    if (accepted_[at] || grid_.passable(at) == inside) return;
    const size_t column = at % grid_.columns, row = at / grid_.columns;
    double a = unknown, b = unknown;
    if (column > 0) a = std::min(a, acceptedAt(at - 1));
    if (column + 1 < grid_.columns) a = std::min(a, acceptedAt(at + 1));
    if (row > 0) b = std::min(b, acceptedAt(at - grid_.columns));
    if (row + 1 < grid_.rows) b = std::min(b, acceptedAt(at + grid_.columns));
    if (a > b) std::swap(a, b);
    const double h = grid_.cell * (inside ? insideCost_ : grid_.cost[at]);
    double time = a + h;
    if (time > b) {
      const double mean = (a + b) / 2, half = (b - a) / 2;
      time = mean + std::sqrt(h * h / 2 - half * half);
    }
    if (time < times_[at]) front_.emplace(times_[at] = time, at);
  }

  using Entry = std::pair<double, size_t>;
  const WayGrid& grid_;
  double insideCost_;
  std::vector<double> times_;
  std::vector<bool> accepted_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front_;
};

}  // namespace

std::vector<double> wayTimes(const WayGrid& grid, std::span<const WayStart> starts, double insideCost) {
  Marching marching(grid, insideCost);
  for (const WayStart& each : starts) marching.start(each);
  marching.march(false);
  marching.march(true);
  return marching.take();
}

}  // namespace skitter::reference

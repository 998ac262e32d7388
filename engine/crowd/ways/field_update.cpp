#include "crowd/ways/field_update.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

#include "shared/eikonal.h"
#include "shared/ways.h"

namespace skitter::crowd {
namespace {

using shared::WAY_FAR;

std::vector<float> givenTimes(const Stops& stops, size_t cells) {
  std::vector<float> given(cells, WAY_FAR);
  for (const auto& [cell, time] : stops.cells) given[cell] = time;
  return given;
}

// Passable cells are updated first. They do not read impassable ones, which read all.
class Updating {
 public:
  Updating(const FieldChange& change, size_t most, std::vector<float>& times)
      : change_(change),
        most_(most),
        times_(times),
        given_(givenTimes(change.stops, times.size())),
        isTouched_(times.size(), false) {}

  bool run() {
    std::vector<size_t> near = nearChanges();
    if (!settle(false, near)) return false;
    for (const size_t cell : std::vector<size_t>(touched_))
      eachNeighbour(cell, [&](size_t other) { near.push_back(other); });
    return settle(true, near);
  }

  FieldUpdate result() const {
    if (touched_.empty()) return {};
    const auto [first, last] = std::ranges::minmax(touched_);
    const auto firstRow = static_cast<uint32_t>(first / change_.columns);
    return {touched_.size(), firstRow, static_cast<uint32_t>(last / change_.columns) - firstRow + 1};
  }

 private:
  template <class Each>
  void eachNeighbour(size_t cell, const Each& each) const {
    const size_t columns = change_.columns, column = cell % columns;
    if (column > 0) each(cell - 1);
    if (column + 1 < columns) each(cell + 1);
    if (cell >= columns) each(cell - columns);
    if (cell + columns < times_.size()) each(cell + columns);
  }

  bool isInside(size_t cell) const { return change_.crossings[cell] < 0; }

  void touch(size_t cell, float time) {
    times_[cell] = time;
    if (isTouched_[cell]) return;
    isTouched_[cell] = true;
    touched_.push_back(cell);
  }

  // The cells whose equations are others than they were. Those that became passable or impassable have no
  // time any more.
  std::vector<size_t> nearChanges() {
    std::vector<size_t> near;
    for (size_t i = 0; i < change_.changed.size(); ++i) {
      const size_t cell = change_.changed[i];
      near.push_back(cell);
      if (isInside(cell) == (change_.before[i] < 0)) continue;
      touch(cell, WAY_FAR);
      eachNeighbour(cell, [&](size_t other) { near.push_back(other); });
    }
    const std::vector<float> before = givenTimes(change_.stopsBefore, times_.size());
    for (size_t cell = 0; cell < before.size(); ++cell)
      if (before[cell] != given_[cell]) near.push_back(cell);
    return near;
  }

  // What the equation makes of a cell's time, from those beside it.
  float timeOf(size_t cell) const {
    const bool inside = isInside(cell);
    const size_t columns = change_.columns, column = cell % columns;
    const auto at = [&](size_t other) { return inside || !isInside(other) ? times_[other] : WAY_FAR; };
    float x = WAY_FAR, z = WAY_FAR;
    if (column > 0) x = at(cell - 1);
    if (column + 1 < columns) x = std::min(x, at(cell + 1));
    if (cell >= columns) z = at(cell - columns);
    if (cell + columns < times_.size()) z = std::min(z, at(cell + columns));
    const float time = shared::eikonal(x, z, std::abs(change_.crossings[cell]));
    return inside ? time : std::min(time, given_[cell]);
  }

  // Takes away the times that are less than they can be, from those cells on. Adds the cells to `cells`.
  bool forget(bool inside, std::vector<size_t>& cells) {
    std::vector<size_t> open = cells;
    while (!open.empty()) {
      const size_t cell = open.back();
      open.pop_back();
      if (isInside(cell) != inside || times_[cell] == WAY_FAR || !(times_[cell] < timeOf(cell))) continue;
      touch(cell, WAY_FAR);
      if (touched_.size() > most_) return false;
      cells.push_back(cell);
      eachNeighbour(cell, [&](size_t other) { open.push_back(other); });
    }
    return true;
  }

  // The cells of one sort that are given, and those that depend on them, have the times of a field solved
  // anew.
  bool settle(bool inside, std::vector<size_t> cells) {
    if (!forget(inside, cells)) return false;
    using Entry = std::pair<float, size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    const auto tryCell = [&](size_t cell) {
      if (isInside(cell) != inside) return;
      if (const float time = timeOf(cell); time < times_[cell]) front.emplace(time, cell);
    };
    std::ranges::for_each(cells, tryCell);
    while (!front.empty()) {
      const auto [time, cell] = front.top();
      front.pop();
      if (!(time < times_[cell])) continue;
      touch(cell, time);
      if (touched_.size() > most_) return false;
      eachNeighbour(cell, tryCell);
    }
    return true;
  }

  const FieldChange& change_;
  const size_t most_;
  std::vector<float>& times_;
  const std::vector<float> given_;
  std::vector<bool> isTouched_;
  std::vector<size_t> touched_;
};

}  // namespace

std::vector<float> crossingsOf(const CostGrid& grid) {
  std::vector<float> crossings = grid.cost;
  for (float& cost : crossings) cost = grid.cell * (std::isfinite(cost) ? cost : -shared::WAY_INSIDE_COST);
  return crossings;
}

std::optional<FieldUpdate> updateField(const FieldChange& change, size_t most, std::vector<float>& times) {
  Updating updating(change, most, times);
  if (!updating.run()) return {};
  return updating.result();
}

}  // namespace skitter::crowd

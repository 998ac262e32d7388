#include "cpu_reference/ways/colony.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <queue>

namespace skitter::reference {
namespace {

constexpr uint32_t fullPheromone = 1u << 20;
constexpr uint64_t longestTrip = (uint64_t{1} << 31) - 1;
// Directions 0 to 7 turn from +x by +z.
constexpr std::array<int, 8> alongX = {1, 1, 0, -1, -1, -1, 0, 1}, alongZ = {0, 1, 1, 1, 0, -1, -1, -1};

// Draw n of SplitMix64 with this key (Steele, Lea and Flood 2014).
uint64_t drawn(uint64_t key, uint64_t n) {
  uint64_t z = key + n * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

uint32_t shareOf(uint64_t amount, uint64_t share) { return static_cast<uint32_t>(amount * share / 4096); }

// Candidate `place` (0 to 8) of the square of nine around a cell, or noWay beyond the map.
uint32_t candidate(const ColonyMap& map, uint32_t cell, uint32_t place) {
  const int64_t x = int64_t{cell % map.columns} + place % 3 - 1;
  const int64_t z = int64_t{cell / map.columns} + place / 3 - 1;
  if (x < 0 || z < 0 || x >= map.columns || z >= map.rows) return Colony::noWay;
  return static_cast<uint32_t>(z * map.columns + x);
}

}  // namespace

Colony::Colony(const ColonyMap& map, const ColonyRecipe& recipe, uint32_t nest, uint32_t goal)
    : map_(map), recipe_(recipe), nest_(nest), goal_(goal) {
  const size_t edges = size_t{8} * map.columns * map.rows;
  pheromone_.assign(edges, recipe.rule == ColonyRule::mmas ? fullPheromone : recipe.least);
  crossings_.assign(edges, 0);
  measure();
}

void Colony::measure() {
  lengths_.assign(pheromone_.size(), noWay);
  desirabilities_.assign(pheromone_.size(), 0);
  for (uint32_t cell = 0; cell < map_.cost.size(); ++cell)
    for (uint32_t direction = 0; direction < 8; ++direction) {
      const uint32_t to = cellBeside(cell, direction);
      if (to == noWay || moveLength(cell, to) == noWay) continue;
      lengths_[8 * size_t{cell} + direction] = moveLength(cell, to);
      desirabilities_[8 * size_t{cell} + direction] = desirability(cell, to);
    }
}

uint32_t Colony::cellBeside(uint32_t cell, uint32_t direction) const {
  const int64_t x = int64_t{cell % map_.columns} + alongX[direction];
  const int64_t z = int64_t{cell / map_.columns} + alongZ[direction];
  if (x < 0 || z < 0 || x >= map_.columns || z >= map_.rows) return noWay;
  return static_cast<uint32_t>(z * map_.columns + x);
}

uint32_t Colony::moveLength(uint32_t from, uint32_t to) const {
  const auto cost = [&](uint32_t x, uint32_t z) { return map_.cost[z * map_.columns + x]; };
  const uint32_t x0 = from % map_.columns, z0 = from / map_.columns;
  const uint32_t x1 = to % map_.columns, z1 = to / map_.columns;
  // A diagonal one does not cut a corner.
  for (const float each : {cost(x0, z0), cost(x1, z1), cost(x0, z1), cost(x1, z0)})
    if (std::isinf(each)) return noWay;
  const auto fixed = [](float value) { return static_cast<uint64_t>(std::floor(256.0 * value + 0.5)); };
  const uint64_t both = fixed(cost(x0, z0)) + fixed(cost(x1, z1));
  return static_cast<uint32_t>(x0 != x1 && z0 != z1 ? (181 * both + 64) / 128 : both);
}

uint32_t Colony::straight(uint32_t cell) const {
  const auto apart = [](uint32_t a, uint32_t b) { return a > b ? a - b : b - a; };
  const uint32_t x = apart(cell % map_.columns, goal_ % map_.columns);
  const uint32_t z = apart(cell / map_.columns, goal_ / map_.columns);
  return 512 * std::max(x, z) + 212 * std::min(x, z);
}

uint32_t Colony::desirability(uint32_t from, uint32_t to) const {
  const int64_t detour = int64_t{moveLength(from, to)} + straight(to) - straight(from);
  const uint64_t ratio = 4096 * uint64_t{recipe_.margin} / static_cast<uint64_t>(recipe_.margin + detour);
  uint64_t eta = 4096;
  for (uint32_t power = 0; power < recipe_.beta; ++power) eta = eta * ratio / 4096;
  return static_cast<uint32_t>(std::max<uint64_t>(eta, 1));
}

uint64_t Colony::lengthOf(const std::vector<uint32_t>& cells) const {
  uint64_t sum = 0;
  for (size_t k = 1; k < cells.size(); ++k) {
    const uint32_t length = moveLength(cells[k - 1], cells[k]);
    if (length == noWay) return UINT64_MAX;
    sum += length;
  }
  return sum;
}

uint32_t Colony::choose(const std::vector<uint32_t>& weights, uint64_t random) const {
  const auto heaviest = std::max_element(weights.begin(), weights.end());  // the first of equals
  if (recipe_.rule == ColonyRule::acs && static_cast<uint32_t>(random) < recipe_.greed)
    return static_cast<uint32_t>(heaviest - weights.begin());
  uint64_t sum = 0;
  for (const uint32_t weight : weights) sum += weight;
  const uint64_t mark = (random >> 32) * sum >> 32;
  uint64_t upTo = 0;
  for (uint32_t direction = 0; direction < 8; ++direction)
    if (mark < (upTo += weights[direction])) return direction;
  std::abort();  // mark < sum
}

ColonyTrip Colony::walk(uint32_t ant) {
  const uint64_t key = drawn(recipe_.seed, static_cast<uint32_t>(iteration_ * recipe_.ants + ant + 1));
  std::vector<bool> seen(map_.cost.size());
  ColonyTrip trip{.cells = {nest_}};
  std::vector<uint64_t> lengths = {0};  // up to each of the cells
  seen[nest_] = true;
  for (uint32_t step = 1; step <= recipe_.steps && trip.cells.back() != goal_; ++step) {
    const uint32_t cell = trip.cells.back();
    std::vector<uint32_t> weights(8, 0);
    for (uint32_t direction = 0; direction < 8; ++direction) {
      const uint32_t to = cellBeside(cell, direction);
      if (to == noWay || seen[to]) continue;
      const size_t edge = 8 * size_t{cell} + direction;
      weights[direction] = pheromone_[edge] / 16 * desirabilities_[edge];
    }
    if (std::all_of(weights.begin(), weights.end(), [](uint32_t weight) { return weight == 0; })) {
      if (cell == nest_) break;
      trip.cells.pop_back();
      lengths.pop_back();
      continue;
    }
    const uint32_t direction = choose(weights, drawn(key, step));
    const uint32_t to = cellBeside(cell, direction);
    const size_t edge = 8 * size_t{cell} + direction;
    ++crossings_[edge];
    seen[to] = true;
    trip.cells.push_back(to);
    lengths.push_back(lengths.back() + lengths_[edge]);
    if (lengths.back() > longestTrip) break;
  }
  trip.arrived = trip.cells.back() == goal_ && lengths.back() <= longestTrip;
  trip.length = static_cast<uint32_t>(lengths.back());
  return trip;
}

bool Colony::tighten(ColonyTrip& trip) const {
  const size_t moves = trip.cells.size() - 1;
  using Nine = std::array<uint64_t, 9>;
  Nine none;
  none.fill(UINT64_MAX);
  std::vector<Nine> least(moves + 1, none);
  std::vector<std::array<uint32_t, 9>> before(moves + 1);
  least[0][4] = 0;
  for (size_t k = 1; k <= moves; ++k)
    for (uint32_t j = 0; j < 9; ++j) {
      const uint32_t to = candidate(map_, trip.cells[k], j);
      if (to == noWay || (k == moves && j != 4)) continue;
      for (uint32_t i = 0; i < 9; ++i) {
        if (least[k - 1][i] == UINT64_MAX) continue;
        const uint32_t from = candidate(map_, trip.cells[k - 1], i);
        uint64_t length = least[k - 1][i];
        if (from != to) {
          uint32_t direction = 0;
          while (direction < 8 && cellBeside(from, direction) != to) ++direction;
          if (direction == 8 || lengths_[8 * size_t{from} + direction] == noWay) continue;
          length += lengths_[8 * size_t{from} + direction];
        }
        if (length < least[k][j]) least[k][j] = length, before[k][j] = i;
      }
    }
  if (least[moves][4] >= trip.length) return false;
  std::vector<uint32_t> cells;
  uint32_t j = 4;
  for (size_t k = moves + 1; k-- > 0; j = before[k][j]) {
    const uint32_t cell = candidate(map_, trip.cells[k], j);
    if (cells.empty() || cells.back() != cell) cells.push_back(cell);
  }
  std::reverse(cells.begin(), cells.end());
  trip.cells = cells;
  trip.length = static_cast<uint32_t>(least[moves][4]);
  return true;
}

const ColonyTrip* Colony::firstOf(size_t begin, size_t end) const {
  const ColonyTrip* first = nullptr;
  for (size_t ant = begin; ant < std::min(end, trips_.size()); ++ant)
    if (trips_[ant].arrived && (!first || trips_[ant].length < first->length)) first = &trips_[ant];
  return first;
}

void Colony::iterate() {
  std::fill(crossings_.begin(), crossings_.end(), 0);
  trips_.clear();
  for (uint32_t ant = 0; ant < recipe_.ants; ++ant) trips_.push_back(walk(ant));
  for (size_t ant = 0; ant < trips_.size(); ant += recipe_.crew)
    if (const ColonyTrip* first = firstOf(ant, ant + recipe_.crew)) {
      ColonyTrip& trip = trips_[static_cast<size_t>(first - trips_.data())];
      for (uint32_t pass = 0; pass < recipe_.passes && tighten(trip);) ++pass;
    }
  ++iteration_;
  const ColonyTrip* laying = firstOf(0, trips_.size());
  if (laying && (!best_.arrived || laying->length < best_.length)) best_ = *laying, found_ = iteration_;
  const bool bestsTurn = recipe_.bestEvery != 0 && iteration_ % recipe_.bestEvery == 0;
  if (recipe_.rule == ColonyRule::acs || !laying || bestsTurn) laying = best_.arrived ? &best_ : nullptr;
  update(laying);
}

void Colony::update(const ColonyTrip* laying) {
  std::vector<bool> laid(pheromone_.size());
  for (size_t k = 1; laying && k < laying->cells.size(); ++k) {
    const uint32_t from = laying->cells[k - 1];
    for (uint32_t direction = 0; direction < 8; ++direction)
      laid[8 * size_t{from} + direction] = cellBeside(from, direction) == laying->cells[k];
  }
  for (size_t edge = 0; edge < pheromone_.size(); ++edge) {
    uint32_t tau = pheromone_[edge];
    if (recipe_.rule == ColonyRule::acs) {
      for (uint32_t n = 0; n < std::min(crossings_[edge], 64u); ++n)
        tau -= shareOf(tau - recipe_.least, recipe_.wear);
      if (laid[edge]) tau += shareOf(fullPheromone - tau, recipe_.evaporation);
    } else {
      tau -= shareOf(tau, recipe_.evaporation);
      if (laid[edge]) tau += shareOf(fullPheromone, recipe_.evaporation);
      tau = std::clamp(tau, recipe_.least, fullPheromone);
    }
    pheromone_[edge] = tau;
  }
}

void Colony::change(const std::vector<uint32_t>& cells, const std::vector<float>& costs) {
  std::vector<bool> near(map_.cost.size());
  for (size_t n = 0; n < cells.size(); ++n) {
    map_.cost[cells[n]] = costs[n];
    const int64_t x = cells[n] % map_.columns, z = cells[n] / map_.columns, radius = recipe_.forgetRadius;
    for (size_t cell = 0; cell < near.size(); ++cell)
      if (std::abs(static_cast<int64_t>(cell % map_.columns) - x) <= radius &&
          std::abs(static_cast<int64_t>(cell / map_.columns) - z) <= radius)
        near[cell] = true;
  }
  measure();
  for (size_t edge = 0; edge < pheromone_.size(); ++edge) {
    if (!near[edge / 8]) continue;
    if (recipe_.rule == ColonyRule::acs)
      pheromone_[edge] -= shareOf(pheromone_[edge] - recipe_.least, recipe_.forget);
    else
      pheromone_[edge] += shareOf(fullPheromone - pheromone_[edge], recipe_.forget);
  }
  if (!best_.arrived) return;
  const uint64_t length = lengthOf(best_.cells);
  if (length <= longestTrip)
    best_.length = static_cast<uint32_t>(length);
  else
    best_ = {}, found_ = 0;
}

uint64_t Colony::shortest() const {
  using Entry = std::pair<uint64_t, uint32_t>;
  std::vector<uint64_t> length(map_.cost.size(), UINT64_MAX);
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  queue.emplace(length[nest_] = 0, nest_);
  while (!queue.empty()) {
    const auto [far, cell] = queue.top();
    queue.pop();
    if (far > length[cell]) continue;
    for (uint32_t direction = 0; direction < 8; ++direction) {
      const uint32_t to = cellBeside(cell, direction);
      const uint32_t move = lengths_[8 * size_t{cell} + direction];
      if (move != noWay && far + move < length[to]) queue.emplace(length[to] = far + move, to);
    }
  }
  return length[goal_];
}

}  // namespace skitter::reference

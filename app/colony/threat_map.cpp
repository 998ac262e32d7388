#include "app/colony/threat_map.h"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace skitter::app {
namespace {

// A linear congruential generator of its own (Knuth's MMIX): the same maps with every standard library.
class MapDice {
 public:
  explicit MapDice(uint64_t seed) : state_(seed) {}
  double between(double least, double most) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return least + (most - least) * static_cast<double>(state_ >> 11) * 0x1p-53;
  }

 private:
  uint64_t state_;
};

// Calls change(cost, column, row) for each cell.
template <class Change>
void eachMapCell(std::vector<double>& costs, uint32_t side, const Change& change) {
  for (uint32_t row = 0; row < side; ++row)
    for (uint32_t column = 0; column < side; ++column)
      change(costs[size_t{row} * side + column], column, row);
}

void addThreat(MapDice& dice, uint32_t side, std::vector<double>& costs) {
  const double x = dice.between(0, side), z = dice.between(0, side);
  const double width = dice.between(0.04, 0.1) * side, height = dice.between(2, 10);
  eachMapCell(costs, side, [&](double& at, double column, double row) {
    const double dx = column - x, dz = row - z;
    at += height * std::exp(-(dx * dx + dz * dz) / (2 * width * width));
  });
}

void addWall(MapDice& dice, uint32_t side, std::vector<double>& costs) {
  const double x = dice.between(0.15, 0.85) * side, z = dice.between(0.1, 0.9) * side;
  double width = dice.between(0.01, 0.04) * side, depth = dice.between(0.02, 0.14) * side;
  if (dice.between(0, 1) < 0.5) std::swap(width, depth);
  eachMapCell(costs, side, [&](double& at, double column, double row) {
    if (std::abs(column - x) < width && std::abs(row - z) < depth)
      at = std::numeric_limits<double>::infinity();
  });
}

}  // namespace

ThreatMap threatMap(uint32_t side, uint64_t number) {
  MapDice dice(number);
  ThreatMap map{.grid = {.columns = side, .rows = side, .cell = 1, .origin = {0, 0}, .cost = {}},
                .nest = {side * 6 / 100, side / 2},
                .goal = {side * 94 / 100, side / 2}};
  std::vector<double> costs(size_t{side} * side, 1);
  for (int threat = 0; threat < 12; ++threat) addThreat(dice, side, costs);
  for (int wall = 0; wall < 10; ++wall) addWall(dice, side, costs);
  for (const glm::uvec2 end : {map.nest, map.goal})
    eachMapCell(costs, side, [&](double& at, double column, double row) {
      if (std::hypot(column - end.x, row - end.y) < 4) at = 1;
    });
  for (const double cost : costs) map.grid.cost.push_back(static_cast<float>(cost));
  return map;
}

}  // namespace skitter::app

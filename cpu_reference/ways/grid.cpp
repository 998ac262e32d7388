#include "cpu_reference/ways/grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cpu_reference/heightfield.h"

namespace skitter::reference {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double mostCells = 512;  // along the longer side

double toSegment(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const double squared = glm::dot(b - a, b - a);
  if (squared == 0) return glm::length(p - a);
  const double t = std::min(1.0, std::max(0.0, glm::dot(p - a, b - a) / squared));
  return glm::length(p - (a + t * (b - a)));
}

bool isIn(const WayPolygon& polygon, const glm::dvec2& p) {
  double least = infinite, most = -infinite;
  for (size_t i = 0; i < polygon.corners.size(); ++i) {
    const glm::dvec2 a = polygon.corners[i], b = polygon.corners[(i + 1) % polygon.corners.size()];
    const double side = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    least = std::min(least, side);
    most = std::max(most, side);
  }
  return least >= 0 || most <= 0;
}

double toNearest(const WayObstacles& obstacles, const glm::dvec2& p) {
  double nearest = infinite;
  for (const WayDisc& disc : obstacles.discs)
    nearest = std::min(nearest, glm::length(p - disc.centre) - disc.radius);
  for (const WayCapsule& capsule : obstacles.capsules)
    nearest = std::min(nearest, toSegment(p, capsule.from, capsule.to) - capsule.radius);
  for (const WayPolygon& polygon : obstacles.polygons) {
    if (isIn(polygon, p)) return std::min(nearest, 0.0);
    for (size_t i = 0; i < polygon.corners.size(); ++i)
      nearest = std::min(nearest,
                         toSegment(p, polygon.corners[i], polygon.corners[(i + 1) % polygon.corners.size()]));
  }
  return nearest;
}

double toNearestThreat(const WayObstacles& obstacles, const glm::dvec2& p) {
  double nearest = infinite;
  for (const WayDisc& disc : obstacles.threats)
    if (disc.radius > 0) nearest = std::min(nearest, glm::length(p - disc.centre) - disc.radius);
  return nearest;
}

struct Ground {
  double slope = 0, ledge = 0;
};
Ground groundAround(const Heights& heights, const glm::dvec2& p, double cell) {
  double h[3][3];  // by z, then x
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      h[j][i] = heightAt(heights, p.x + (i - 1) * cell / 2, p.y + (j - 1) * cell / 2);
  const double gx = (h[1][2] - h[1][0]) / cell, gz = (h[2][1] - h[0][1]) / cell;
  Ground ground{.slope = std::sqrt(gx * gx + gz * gz)};
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 2; ++i)
      ground.ledge = std::max({ground.ledge, std::abs(h[j][i + 1] - h[j][i] - gx * cell / 2),
                               std::abs(h[i + 1][j] - h[i][j] - gz * cell / 2)});
  return ground;
}

size_t indexAlong(double place, double origin, double cell, size_t count) {
  const double index = std::floor((place - origin) / cell);
  return static_cast<size_t>(std::min(std::max(index, 0.0), static_cast<double>(count - 1)));
}

// The cells beside one over its four sides.
std::vector<size_t> beside(const WayGrid& grid, size_t at) {
  std::vector<size_t> all;
  if (at % grid.columns > 0) all.push_back(at - 1);
  if (at % grid.columns < grid.columns - 1) all.push_back(at + 1);
  if (at >= grid.columns) all.push_back(at - grid.columns);
  if (at + grid.columns < grid.cells()) all.push_back(at + grid.columns);
  return all;
}

// The least cell of each cell's region: names it. Impassable ones have their own numbers.
std::vector<size_t> regionNames(const WayGrid& grid) {
  std::vector<size_t> names(grid.cells(), grid.cells());
  for (size_t first = 0; first < names.size(); ++first) {
    if (names[first] < grid.cells()) continue;
    std::vector<size_t> front = {first};
    names[first] = first;
    while (grid.passable(first) && !front.empty()) {
      std::vector<size_t> next;
      for (const size_t at : front)
        for (const size_t other : beside(grid, at))
          if (grid.passable(other) && names[other] == grid.cells()) {
            names[other] = first;
            next.push_back(other);
          }
      front = std::move(next);
    }
  }
  return names;
}

}  // namespace

glm::dvec2 WayGrid::middle(size_t at) const {
  return origin +
         cell * (glm::dvec2(static_cast<double>(at % columns), static_cast<double>(at / columns)) + 0.5);
}
bool WayGrid::passable(size_t at) const { return cost[at] < infinite; }

WayGrid wayGrid(const Heights& heights, const WayObstacles& obstacles, const WayTuning& tuning) {
  const glm::dvec2 sides((heights.columns - 1) / heights.inverseSpacingX,
                         (heights.rows - 1) / heights.inverseSpacingZ);
  WayGrid grid;
  grid.cell = std::max(tuning.legLength / 2, std::max(sides.x, sides.y) / mostCells);
  // A last cell of less than a millionth is none.
  grid.columns = std::max<size_t>(2, static_cast<size_t>(std::ceil(sides.x / grid.cell * (1 - 1e-6))));
  grid.rows = std::max<size_t>(2, static_cast<size_t>(std::ceil(sides.y / grid.cell * (1 - 1e-6))));
  grid.origin = {heights.originX, heights.originZ};
  const double grown = std::max(tuning.footprint, grid.cell / std::sqrt(2.0));
  const double highest = tuning.step * tuning.legLength;
  for (size_t at = 0; at < grid.cells(); ++at) {
    const glm::dvec2 p = grid.middle(at);
    const Ground ground = groundAround(heights, p, grid.cell);
    const glm::dvec2 inward = sides / 2.0 - tuning.edgeMargin - glm::abs(p);
    const double decisions[] = {
        1 - ground.slope / tuning.steepest, 1 - ground.ledge / highest, toNearest(obstacles, p) / grown - 1,
        toNearestThreat(obstacles, p) / (grown + grid.cell) - 1, std::min(inward.x, inward.y) / grid.cell};
    const double least = *std::min_element(std::begin(decisions), std::end(decisions));
    grid.cost.push_back(least < 0 ? infinite : 1 + tuning.climb * ground.slope);
    grid.margin.push_back(std::abs(least));
  }
  return grid;
}

std::vector<WayStart> wayStarts(const WayGrid& grid, const glm::dvec2& goal) {
  if (goal == glm::dvec2(wayOut)) {
    std::vector<WayStart> all;
    for (size_t at = 0; at < grid.cells(); ++at)
      if (grid.passable(at)) all.push_back({at, 0});
    return all;
  }
  const std::vector<size_t> names = regionNames(grid);
  const size_t goalCell = indexAlong(goal.y, grid.origin.y, grid.cell, grid.rows) * grid.columns +
                          indexAlong(goal.x, grid.origin.x, grid.cell, grid.columns);
  std::vector<size_t> nearest(grid.cells(), grid.cells());  // by a region's name
  std::vector<WayStart> starts;
  for (size_t at = 0; at < grid.cells(); ++at) {
    if (!grid.passable(at)) continue;
    const glm::dvec2 away = grid.middle(at) - goal;
    if (grid.passable(goalCell) && names[at] == names[goalCell]) {
      if (std::abs(away.x) < grid.cell && std::abs(away.y) < grid.cell)
        starts.push_back({at, grid.cost[at] * glm::length(away)});
      continue;
    }
    size_t& best = nearest[names[at]];
    if (best == grid.cells() || glm::length(away) < glm::length(grid.middle(best) - goal)) best = at;
  }
  for (const size_t at : nearest)
    if (at < grid.cells()) starts.push_back({at, 0});
  return starts;
}

}  // namespace skitter::reference

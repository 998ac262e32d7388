#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cpu_reference/types.h"

// Cost grids, stops and times of docs/ways.md. Places are world x, z.
namespace skitter::reference {

struct WayDisc {
  glm::dvec2 centre{0};
  double radius = 0;
};
struct WayCapsule {
  glm::dvec2 from{0}, to{0};
  double radius = 0;
};
struct WayPolygon {
  std::vector<glm::dvec2> corners;  // convex, either way round
};
struct WayObstacles {
  std::vector<WayDisc> discs = {};
  std::vector<WayCapsule> capsules = {};
  std::vector<WayPolygon> polygons = {};
  std::vector<WayDisc> threats = {};  // a cell farther
};

// Whom a grid is for.
struct WayTuning {
  double legLength = 0, footprint = 0, edgeMargin = 0;
  double climb = 0, steepest = 0, step = 0;
};

// Cells row after row.
struct WayGrid {
  size_t columns = 0, rows = 0;
  double cell = 0;
  glm::dvec2 origin{0};           // corner of cell (0, 0)
  std::vector<double> cost = {};  // infinite where impassable
  // How far each cell is from being passable where it is not, or from not being so: the least of the
  // distances to its decisions, as shares of their limits.
  std::vector<double> margin = {};

  size_t cells() const { return columns * rows; }
  glm::dvec2 middle(size_t at) const;
  bool passable(size_t at) const;
};
WayGrid wayGrid(const Heights& heights, const WayObstacles& obstacles, const WayTuning& tuning);

// A place where the time of a field is given.
struct WayStart {
  size_t cell = 0;
  double time = 0;
};
// x and z of the goal of those who flee.
inline constexpr double wayOut = 1e6;
// Where agents stop whose goal this is, region by region; who flees, at every passable cell.
std::vector<WayStart> wayStarts(const WayGrid& grid, const glm::dvec2& goal);

// The times at the middles of all cells, impassable ones at `insideCost`; infinite where nothing leads to a
// start. By fast marching: Sethian 1996, A fast marching level set method for monotonically advancing fronts,
// PNAS 93:1591-1595.
std::vector<double> wayTimes(const WayGrid& grid, std::span<const WayStart> starts, double insideCost);

}  // namespace skitter::reference

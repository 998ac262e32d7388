#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <variant>
#include <vector>

#include "skitter/export.h"
#include "skitter/heightfield.h"

// Obstacles, threats and cost grids, by which herds find their way (docs/ways.md). Places are world x, z in
// metres.
namespace skitter {

// An obstacle stands on the ground and does not move. Shapes are as seen from above.
struct Disc {
  glm::vec2 centre{0};
  float radius = 1;  // minRadius to Scene::maxCoordinate

  static constexpr double minRadius = 0.01;
  bool operator==(const Disc&) const = default;
};
// All that is within `radius` of the line from `from` to `to`.
struct Capsule {
  glm::vec2 from{0}, to{0};
  float radius = 0;  // 0 to Scene::maxCoordinate

  bool operator==(const Capsule&) const = default;
};
struct ConvexPolygon {
  static constexpr size_t minCorners = 3, maxCorners = 64;

  std::vector<glm::vec2> corners;  // in order, either way round; none lies on a line with its neighbours

  bool operator==(const ConvexPolygon&) const = default;
};
struct Obstacle {
  std::variant<Disc, Capsule, ConvexPolygon> shape;

  bool operator==(const Obstacle&) const = default;
};

// Ground that herds with ways keep off, seen from above. Threats come, move and go while a crowd runs
// (Crowd::setThreat).
struct Threat {
  glm::vec2 centre{0};
  float radius = 1;  // to Scene::maxCoordinate; 0: there is none

  bool operator==(const Threat&) const = default;
};

// How hard ground is for the creatures of a herd that finds its way.
struct Ways {
  static constexpr double maxClimb = 100, minLimit = 0.01, maxLimit = 100;

  // How much longer a metre takes for each metre of rise a metre, the mean of up and down; 0 to maxClimb.
  float climb = 1.5f;
  float steepest = 1.5f;  // rise over run beyond which ground is impassable, minLimit to maxLimit
  float step = 0.5f;      // leg lengths, height of a ledge that is just passable, minLimit to maxLimit

  bool operator==(const Ways&) const = default;
};

// Square cells over a terrain, row after row along +z.
struct CostGrid {
  uint32_t columns = 0, rows = 0;  // at least 2
  float cell = 0;                  // metres a side
  glm::vec2 origin{0};             // x, z of the corner of cell (0, 0)
  // cost[row * columns + column] is the time that a metre through the cell takes, over that of flat ground:
  // at least 1, infinite where it is impassable.
  std::vector<float> cost = {};

  bool operator==(const CostGrid&) const = default;
};

// Whom a grid is for.
struct Traveller {
  float legLength = 1;  // metres
  float footprint = 0;  // metres, radius of the disc on the ground that it takes
  float margin = 0;     // metres that it keeps from the edge of the map
  Ways ways = {};
  float cell = 0;  // metres a side of its cells; 0: half a leg length; more where the terrain is large
};

// Throws Error(input) where the terrain, the traveller or an obstacle cannot be.
SKITTER_API CostGrid costGrid(const Heightfield& terrain, std::span<const Obstacle> obstacles,
                              const Traveller& traveller);
// Makes the cells impassable that are too near to a threat. Throws Error(input) where the grid, the traveller
// or a threat cannot be.
SKITTER_API void keepOff(CostGrid& grid, std::span<const Threat> threats, const Traveller& traveller);

}  // namespace skitter

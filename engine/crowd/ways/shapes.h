#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "skitter/ways.h"

// The shapes of obstacles on the plane, world x, z in metres.
namespace skitter::crowd {

// Less than 0 or 0 inside.
double distanceTo(const Obstacle& obstacle, const glm::dvec2& place);

struct ShapeBounds {
  glm::dvec2 least, most;
};
ShapeBounds boundsOf(const Obstacle& obstacle);

// The corners in the order in which +x turns to +z.
std::vector<glm::vec2> cornersOf(const ConvexPolygon& polygon);

}  // namespace skitter::crowd

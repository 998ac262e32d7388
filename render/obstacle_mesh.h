#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "skitter/ways.h"

namespace skitter::render {

struct ObstacleVertex {
  glm::vec3 place;   // world x, z; metres above the ground
  glm::vec3 normal;  // where the ground is level, unit
};
struct ObstacleMesh {
  std::vector<ObstacleVertex> vertices;
  std::vector<uint32_t> indices;  // triangles, counter-clockwise from outside
};

// Obstacles as walls and posts `height` metres high, all in one mesh. Their tops follow the ground, in steps
// of about `step` metres, of more where so many vertices would be beyond a million. A skirt goes below the
// ground.
ObstacleMesh obstacleMesh(std::span<const Obstacle> obstacles, float height, float step);

}  // namespace skitter::render

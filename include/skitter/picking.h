#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

namespace skitter {

// Which agent is under a ray or nearest to a point: Crowd::pick(), Snapshot::pick(). An agent is picked by a
// sphere about the middle of its body, of a radius that reaches the ground, or the body's ends where these
// are further away.
struct Ray {
  glm::dvec3 start{0};
  glm::dvec3 direction{0, 0, 1};                            // of any length but 0, else Error(input)
  double length = std::numeric_limits<double>::infinity();  // metres
};

struct Picked {
  uint32_t herd = 0, agent = 0;  // agent of the herd
  double distance = 0;           // metres, from the ray's start to the sphere; from the point to the sphere's
                                 // middle
  glm::dvec3 place{0};           // position where the ray meets the sphere; the sphere's middle
};

}  // namespace skitter

#pragma once

#include <glm/glm.hpp>

#include "skitter/crowd.h"

namespace skitter::app {

// A mound that wanders across the way of the first herd: a heightfield edited in every tick.
class Obstacle {
 public:
  explicit Obstacle(const Crowd& crowd);

  // To where it is in the next tick, `seconds` after the start.
  void move(Crowd& crowd, double seconds);

 private:
  Heightfield ground_;  // as it was
  glm::vec2 start_;     // world x, z
  float radius_, height_, width_;
  struct {
    uint32_t x = 0, z = 0, columns = 0, rows = 0;
  } covered_;
};

}  // namespace skitter::app

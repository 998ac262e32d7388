#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include "skitter/crowd.h"

namespace skitter::app {

// A mound that wanders across the way of the first herd: a heightfield edited in every tick.
class Obstacle {
 public:
  explicit Obstacle(const Crowd& crowd);
  // Goes on where a saved run had it: `crowd` is made of the state, and json() gave `saved`.
  Obstacle(const Crowd& crowd, const nlohmann::ordered_json& saved);

  // To where it is in the next tick, `seconds` after the start.
  void move(Crowd& crowd, double seconds);
  const Heightfield& groundWithout() const { return ground_; }
  nlohmann::ordered_json json() const;

 private:
  Heightfield ground_;  // as it was
  glm::vec2 start_;     // world x, z
  float radius_, height_, width_;
  struct Rectangle {
    uint32_t x = 0, z = 0, columns = 0, rows = 0;
  } covered_;  // samples
};

}  // namespace skitter::app

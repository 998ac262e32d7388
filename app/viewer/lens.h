#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "skitter/renderer.h"

namespace skitter::app {

// Where points of the world are in a picture.
class Lens {
 public:
  Lens(const View& view, float width, float height);

  // In pixels from the top left corner; none for what is not in front of the eye.
  std::optional<glm::vec2> pixel(const glm::vec3& world) const;
  float depth(const glm::vec3& world) const;  // metres along the line of sight
  float pixelsAMetre(float depth) const { return focal_ / depth; }
  const glm::vec3& eye() const { return eye_; }
  glm::vec2 middle() const { return middle_; }

 private:
  glm::vec3 eye_, forward_, right_, up_;
  glm::vec2 middle_;
  float focal_;
};

}  // namespace skitter::app

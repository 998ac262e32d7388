#include "app/viewer/lens.h"

#include <cmath>

namespace skitter::app {

Lens::Lens(const View& view, float width, float height)
    : eye_(view.eye),
      middle_(0.5f * width, 0.5f * height),
      focal_(0.5f * height / std::tan(0.5f * view.fieldOfView)) {
  const glm::vec3 line = view.target - view.eye;
  forward_ = glm::length(line) > 1e-6f ? glm::normalize(line) : glm::vec3(0, 0, 1);
  const glm::vec3 skyward = std::abs(forward_.y) < 0.9999f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1);
  right_ = glm::normalize(glm::cross(forward_, skyward));
  up_ = glm::cross(right_, forward_);
}

float Lens::depth(const glm::vec3& world) const { return glm::dot(world - eye_, forward_); }

std::optional<glm::vec2> Lens::pixel(const glm::vec3& world) const {
  const float along = depth(world);
  if (along < 0.02f) return std::nullopt;
  const glm::vec3 to = world - eye_;
  return middle_ + glm::vec2(glm::dot(to, right_), -glm::dot(to, up_)) * pixelsAMetre(along);
}

}  // namespace skitter::app

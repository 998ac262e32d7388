#include "skitter/material.h"

#include <cmath>

namespace skitter {

// The extension's page has the matrix of the other turn; its examples, and all who draw by it, have this one.
std::array<glm::vec3, 2> Texture::rows() const {
  const float c = std::cos(rotation), s = std::sin(rotation);
  return {glm::vec3(c * scale.x, s * scale.y, offset.x), glm::vec3(-s * scale.x, c * scale.y, offset.y)};
}

bool Look::operator==(const Look& other) const {
  if (vertices != other.vertices || !materials != !other.materials) return false;
  return materials == other.materials || *materials == *other.materials;
}

}  // namespace skitter

#pragma once

#include <glm/glm.hpp>

namespace skitter {

// What an agent carries (docs/loads.md).
struct Load {
  static constexpr float maxMass = 4, maxOffset = 2;

  float mass = 0;       // times its own mass, 0 to maxMass; 0: it carries nothing
  glm::vec3 offset{0};  // of the load's centre from the body's: x to the left, y up, z forward, each at most
                        // maxOffset leg lengths either way

  bool operator==(const Load&) const = default;
};

}  // namespace skitter

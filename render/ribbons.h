#pragma once

#include <vector>

#include "skitter/rig.h"

namespace skitter::render {

// A thin bone of a leg as a strip that turns to whoever looks at it. From afar the bone's surface would fall
// between pixels; a strip is drawn at least as wide as one (after Persson 2012, "Phone-wire AA").
struct Ribbon {
  struct End {
    float along;   // metres from the bone's start along its direction
    float radius;  // metres, the mean distance of the skin from the bone's axis
    glm::vec3 colour;
  };
  uint16_t bone;        // of the pose palette
  glm::vec3 direction;  // unit, the bone's at rest
  End from, to;
};

struct Ribbons {
  std::vector<Ribbon> ribbons;
  std::vector<uint32_t> others;  // indices of the triangles that no ribbon stands for
};
// Ribbons for the leg bones whose radius is at most `radius` metres.
Ribbons ribbonsOf(const Rig&, float radius);

}  // namespace skitter::render

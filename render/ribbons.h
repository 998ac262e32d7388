#pragma once

#include <optional>
#include <vector>

#include "skitter/rig.h"

namespace skitter::render {

// The entry of the pose palette that carries most of a vertex.
uint16_t heaviestBone(const SkinVertex&);

// Thin bones of a leg, one after another, as a strip that turns to whoever looks at it. From afar the bones'
// surface would fall between pixels; a strip is drawn at least as wide as one (after Persson 2012,
// "Phone-wire AA").
struct Ribbon {
  struct End {
    uint16_t bone;        // of the pose palette
    glm::vec3 direction;  // unit, the bone's at rest
    float along;          // metres from the bone's start along its direction
    float radius;         // metres, the mean distance of the skin from the bone's axis
    glm::vec3 colour;
  };
  End from, to;
  // In the middle of a single bone, where its skin there has another colour or radius than the ends' mean.
  std::optional<End> waist;
};

struct Ribbons {
  std::vector<Ribbon> ribbons;
  std::vector<uint32_t> others;  // indices of the triangles that no ribbon stands for
};
// Ribbons for the leg bones whose radius is at most `radius` metres. Bones that follow each other are one
// ribbon where no joint between them is more than `bend` metres off the straight line at rest. `waists`:
// whether ribbons may have them.
Ribbons ribbonsOf(const Rig&, float radius, float bend, bool waists);

}  // namespace skitter::render

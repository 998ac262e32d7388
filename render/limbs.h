#pragma once

#include <cstdint>
#include <vector>

#include "crowd/herd.h"
#include "render/ribbons.h"
#include "skitter/clip.h"
#include "skitter/rig.h"

namespace skitter::render {

// A model as its legs and its body, by which it is drawn where its surface is too fine, and by which it
// darkens the ground. A model that plays clips has more joints than legs have bones: here its skin hangs on
// the legs' bones alone, in the pose in which it was bound.
struct Limbs {
  // The entry of the pose palette that carries a bone, and where the bone starts from where that entry does,
  // metres. Entries of matrices start at the origin.
  struct Carrier {
    uint16_t entry = 0;
    glm::vec3 start{0};
  };

  Rig rig;                        // legs, and a skin with the colours that its textures give it; no look
  std::vector<Carrier> carriers;  // by entry of `rig`
  std::vector<uint16_t> entries;  // by vertex: that of the palette which carries most of it

  // From where the entry that carries the bone starts.
  glm::vec3 placeOf(const Ribbon::End& end) const {
    return carriers[end.bone].start + end.along * end.direction;
  }
};

Limbs limbsOf(const Rig&);
Limbs limbsOf(const ClipSet&);
Limbs limbsOf(const crowd::Kind&);

}  // namespace skitter::render

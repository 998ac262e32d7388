#pragma once

#include <vector>

#include "render/picture.h"
#include "skitter/rig.h"

namespace skitter::render {

// A rig as the fewest shapes that still move as simulated: a capsule for each leg bone, or for bones that lie
// in a line to `bend` metres at rest, and balls for the body. None of a rig without a skin.
std::vector<shared::SplatPart> splatPartsOf(const Rig&, float bend);

}  // namespace skitter::render

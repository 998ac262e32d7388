#pragma once

#include <vector>

#include "render/limbs.h"
#include "render/picture.h"

namespace skitter::render {

// A model as the fewest shapes that still move as simulated: a capsule for each leg bone, or for bones that
// lie in a line to `bend` metres at rest, and balls for the body. None of a model without a skin.
std::vector<shared::SplatPart> splatPartsOf(const Limbs&, float bend);

}  // namespace skitter::render

#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "skitter/rig.h"

namespace skitter {

// The colour of each vertex as one sees it from afar: its own times that of the base colour texture there,
// of a level with at most 64 texels a side. Without a look, or where an image cannot be decoded, its own.
std::vector<glm::vec3> wornColours(const std::vector<SkinVertex>& vertices, const Look& look);

}  // namespace skitter

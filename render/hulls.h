#pragma once

#include <vector>

#include "render/mesh.h"

namespace skitter::render {

// Hulls that hold all triangles of a mesh, at every level of detail and in every pose, one after the other:
// of each set of bones whose skin triangles join, the boxes of these. Where that would be more than a few
// hundred boxes, one hull of all.
std::vector<shared::HullBox> hullsOf(const MeshData&);

}  // namespace skitter::render

#pragma once

#include "assets/models/gltf.h"
#include "assets/models/gltf_source.h"

namespace skitter::gltf {

// Fills nodes and parentsFirst.
void readNodes(Source& source, Document& document);

}  // namespace skitter::gltf

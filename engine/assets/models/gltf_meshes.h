#pragma once

#include "assets/models/gltf.h"
#include "assets/models/gltf_source.h"

namespace skitter::gltf {

// Points and lines are left out, with a note.
Mesh readMesh(Source& source, const Materials& materials, size_t index);
// Its joints are nodes of the file.
Skin readSkin(Source& source, const Document& document, size_t index);

}  // namespace skitter::gltf

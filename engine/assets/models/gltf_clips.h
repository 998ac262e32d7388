#pragma once

#include "assets/models/gltf.h"
#include "assets/models/gltf_source.h"

namespace skitter::gltf {

// Fills clips, of a document with nodes. A fault in a clip costs the clip, not the file: nothing else depends
// on it.
void readClips(Source& source, Document& document);

}  // namespace skitter::gltf

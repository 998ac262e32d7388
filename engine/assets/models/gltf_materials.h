#pragma once

#include "assets/models/gltf_source.h"
#include "skitter/material.h"

namespace skitter::gltf {

// As many materials as the file has, and the images that their textures refer to, not decoded. Materials that
// no mesh wears are not read. A fault is a note: a texture that cannot be had is left out, a number out of
// range counts as the usual one.
Materials readMaterials(Source& source);

// Whether anything is looked up for it.
bool isTextured(const Material& material);
// Whether a colour at each vertex is all that it takes to draw it.
bool isPlain(const Material& material);

}  // namespace skitter::gltf

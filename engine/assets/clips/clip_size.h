#pragma once

#include <string>
#include <vector>

#include "assets/clips/clip_skin.h"
#include "assets/models/gltf.h"

namespace skitter {

// The clip, in the size that the skin has at rest: exporters that count in centimetres leave the scale of an
// armature to the rest pose or to the clips alone, so that a clip shows its creature 100 times as large. A
// clip whose size changes while it plays stays as it is. `what` names the clip in the notes, which say what
// was changed, and what cannot be.
gltf::Clip inRestSize(const gltf::Document& document, const gltf::Clip& clip, const ClipSkin& skin,
                      const std::string& what, std::vector<std::string>& notes);

}  // namespace skitter

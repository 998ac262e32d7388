#pragma once

#include "cpu_reference/clips/table.h"

namespace skitter::reference {

// M of a joint of the palette: between frames, then between clips.
Affine blended(const ClipTable& table, const Play& play, size_t joint);
// The joints p_0 .. p_bones of a leg, in model space.
std::vector<glm::dvec3> blendedJoints(const ClipTable& table, const Play& play, size_t leg);
// Whether the leg stands in the clip of the greater weight.
bool standsInClip(const ClipTable& table, const Play& play, size_t leg);

}  // namespace skitter::reference

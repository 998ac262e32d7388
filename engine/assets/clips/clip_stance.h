#pragma once

#include "skitter/clip.h"

namespace skitter {

// Which feet stand at which frame, and from that the clip's speed and ground (docs/clip.md, Stance and
// speed).
void findStance(Clip& clip, size_t legs, double legLength);

}  // namespace skitter

#pragma once

#include "crowd/herd.h"

namespace skitter::crowd {

// Of a sphere about an agent's position that holds every pose, metres.
float radiusOf(const Rig&);
float radiusOf(const ClipSet&);  // where clips move the skin
float radiusOf(const Kind&);
float radiusOf(const Crowd::Impl&, const Herd&);  // of its largest size

// Metres: the radius of the disc on the ground that holds the trunk and half of the way to the farthest
// home.
float footprintRadius(const Rig&);

}  // namespace skitter::crowd

#pragma once

#include "crowd/herd.h"

namespace skitter::crowd {

// Of a sphere about an agent's position that holds every pose, metres.
float radiusOf(const Rig&);
float radiusOf(const ClipSet&);  // where clips move the skin
float radiusOf(const Kind&);

}  // namespace skitter::crowd

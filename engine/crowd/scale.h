#pragma once

#include "skitter/clip.h"
#include "skitter/rig.h"

namespace skitter::crowd {

// The same creature, its clips included, `size` times as large.
Rig scaled(Rig rig, float size);
ClipSet scaled(ClipSet set, float size);

}  // namespace skitter::crowd

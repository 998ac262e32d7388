#pragma once

#include "skitter/rig.h"
#include "skitter/scene.h"

// Worlds that a program made itself may be anything. Each throws Error(input) naming what cannot be.
namespace skitter::crowd {

void checkRig(const Rig& rig);
// Ground, obstacles and threats; herds have checkHerd (crowd/kinds.h).
void checkWorld(const Heightfield& terrain, const Scene& scene);

}  // namespace skitter::crowd

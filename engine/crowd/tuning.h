#pragma once

#include "shared/parameters.h"
#include "skitter/heightfield.h"
#include "skitter/rig.h"

namespace skitter::crowd {

// Iterations of the ik stage a tick; docs/stages.md says what each buys.
inline constexpr int kFabrikIterations = 4;
inline constexpr int kPolishIterations = 2;

// The tuning that ships, scaled to the rig, for ticks of `dt` seconds on this terrain.
shared::Parameters tuningFor(const Rig& rig, const Heightfield& terrain, float dt);

}  // namespace skitter::crowd

#pragma once

#include "crowd/herd.h"

namespace skitter::crowd {

constexpr float usualDt = 1.0f / 60;  // until the first tick says otherwise

// The numbers of the kind's tuning, for ticks of `dt` seconds.
void setParameters(const Crowd::Impl& crowd, float dt, Kind& kind);

// Adds the herd of that event of the scene, from what Impl::coming has of it. Throws as Crowd::addHerd; then
// it can be called again.
HerdId addComing(Crowd::Impl& crowd, size_t event);

// From the first tick on dt stays what it is. Throws Error(input) as Crowd::record does.
void setTick(Crowd::Impl& crowd, float dt);

}  // namespace skitter::crowd

#pragma once

#include "crowd/herd.h"

namespace skitter::crowd {

constexpr float usualDt = 1.0f / 60;  // until the first tick says otherwise

// The numbers of the kind's tuning, for ticks of `dt` seconds.
void setParameters(const Crowd::Impl& crowd, float dt, Kind& kind);

// From the first tick on dt stays what it is. Throws Error(input) as Crowd::record does.
void setTick(Crowd::Impl& crowd, float dt);

}  // namespace skitter::crowd

#pragma once

#include <memory>

#include "crowd/herd.h"
#include "crowd/kinds.h"
#include "skitter/state.h"

namespace skitter::crowd {

constexpr float usualDt = 1.0f / 60;  // until the first tick says otherwise

// A crowd as Crowd's constructors make it, of a scene or of a state. Throws as they do.
std::unique_ptr<Crowd::Impl> makeCrowd(Device& device, const Heightfield& terrain, const Scene& scene,
                                       const Kinds& kinds, const CrowdOptions& options);
std::unique_ptr<Crowd::Impl> remakeCrowd(Device& device, const State& state);

// The rig that the herd's file has. Throws Error(input) as loadRig does.
Rig rigFor(const skitter::Herd& from);

// Makes a herd with that number, which no herd has, and with kinds of its own. Waits for the device. Throws
// Error(device) where there is no memory for it; then the crowd is as it was.
HerdId makeHerd(Crowd::Impl& crowd, uint32_t number, const skitter::Herd& from, const Rig& rig);

// The herd is gone: its number is free.
void vacate(Crowd::Impl& crowd, uint32_t number);

// The numbers of the kind's tuning, for ticks of `dt` seconds.
void setParameters(const Crowd::Impl& crowd, float dt, Kind& kind);

// Adds the herd of that event of the scene, from what Impl::coming has of it. Throws as Crowd::addHerd; then
// it can be called again.
HerdId addComing(Crowd::Impl& crowd, size_t event);

// From the first tick on dt stays what it is. Throws Error(input) as Crowd::record does.
void setTick(Crowd::Impl& crowd, float dt);

}  // namespace skitter::crowd

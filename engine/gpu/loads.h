#pragma once

#include "gpu/context.h"

#include <functional>
#include <optional>

namespace skitter::gpu {

// Under this, a page of records may not fit one texel view.
constexpr uint64_t kEnoughTexels = 1ull << 24;

// The path that a request names, or else the environment variable SKITTER_LOADS ("texel" or "storage").
// Throws Error(input) when that says something else.
std::optional<LoadPath> wantedLoads(std::optional<LoadPath> requested);

// `measure` is called only where both paths are possible and none is wanted; it gives nothing where the
// device's time cannot be told.
LoadChoice chooseLoads(const DeviceLimits&, const DeviceFeatures&, std::optional<LoadPath> wanted,
                       const std::function<std::optional<LoadCost>()>& measure);

// Reads records by both paths in turns, the best of several: a few milliseconds. CPU time of all threads on a
// software device, timestamps elsewhere; nothing where there are none. Leaves the context reading by storage.
std::optional<LoadCost> measureLoads(Context&);

}  // namespace skitter::gpu

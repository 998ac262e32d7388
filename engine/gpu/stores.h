#pragma once

#include "gpu/context.h"

#include <functional>
#include <optional>

namespace skitter::gpu {

// The width that a request names, or else the environment variable SKITTER_STORES ("32" or "64"). Throws
// Error(input) when that says something else.
std::optional<StoreWidth> wantedStores(std::optional<StoreWidth> requested);

// `measure` is called only where both widths are possible, with texel loads, and none is wanted; it gives
// nothing where the device's time cannot be told.
StoreChoice chooseStores(LoadPath, std::optional<StoreWidth> wanted,
                         const std::function<std::optional<StoreCost>()>& measure);

// Writes records by both widths in turns, the best of several: a few milliseconds, timed as loads are.
// Nothing where that is impossible. Leaves the context writing by 32 bits.
std::optional<StoreCost> measureStores(Context&);

}  // namespace skitter::gpu

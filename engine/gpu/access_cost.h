#pragma once

#include "gpu/context.h"

#include <optional>

// What a record's load and store cost on a device. Each is measured in a few milliseconds: CPU time of all
// threads on a software device, timestamps elsewhere; nothing where there are none.
namespace skitter::gpu {

// Reads records by both paths in turns, the best of several. Leaves the context reading by storage.
std::optional<LoadCost> measureLoads(Context&);

// Writes records by both widths in turns, the best of several. Leaves the context writing by 32 bits.
std::optional<StoreCost> measureStores(Context&);

}  // namespace skitter::gpu

#pragma once

#include <cstdint>

#include "crowd/herd.h"

// Whom measure looks at (docs/stages/measure.md): one agent of every `every`, for WATCH_TICKS in a row.
namespace skitter::crowd {

// As asked for; else everybody in a small crowd, and few enough in a large one that measure takes less than
// a twentieth of the tick.
uint32_t watchEvery(const CrowdOptions& options, uint64_t agents);

struct Watch {
  uint32_t first;    // agent of the page
  uint32_t count;    // first, first + every, ...
  uint32_t watched;  // ticks since the watch began
};
Watch watchAt(uint64_t tick, uint32_t every, const Page& page);

}  // namespace skitter::crowd

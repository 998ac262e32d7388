#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "crowd/herd.h"

// How the kinds of a crowd come to their fields (docs/ways.md).
namespace skitter::crowd {

// The kind's grid, and the fields of the goals that its herds have and that events of the scene name, as far
// as there is room. Before its pages are made, which bind them. Of a kind whose herds find no way: nothing.
// `isNew`: the kind has goals in series yet to come; else those of a state. Throws Error(input) where its
// herds' goals in series have more places than there may be.
void beginWays(Crowd::Impl& crowd, uint32_t kind, bool isNew);

// Fields for goals that agents of a run are about to have. Waits for the device where one is new. Throws
// Error(input) where all fields are of goals that agents have; `name` makes the text that says who it is
// about.
void leadTo(Crowd::Impl& crowd, const Herd& herd, const SizeRun& run, std::span<const Goal> goals,
            const std::function<std::string()>& name);

// Fields for the goals that all agents have, as their records say, as far as there is room.
void leadEverybody(Crowd::Impl& crowd);

// Grids and fields for the ground and the threats of the next tick. Waits for the device where they are
// others than in the last one, and where it looks at agents that are threats.
void keepWays(Crowd::Impl& crowd);

}  // namespace skitter::crowd

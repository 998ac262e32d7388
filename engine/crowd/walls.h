#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "crowd/herd.h"

// Obstacles for stage avoid (docs/stages/avoid.md).
namespace skitter::crowd {

// BINDING_WALL: each cell of a grid over the terrain has the edges of all obstacles within `reach` metres of
// it. Cells are larger where the records would be more than `most` vec4 otherwise; none where even one cell
// has more.
std::optional<std::vector<float>> wallRecords(const Heightfield& terrain, std::span<const Obstacle> obstacles,
                                              float reach, uint64_t most);

// For a kind whose herds avoid. Throws Error(device) where a binding does not reach the records.
gpu::Buffer makeWalls(const Crowd::Impl& crowd, const Kind& kind);

}  // namespace skitter::crowd

#pragma once

#include <cstddef>
#include <glm/glm.hpp>

#include "crowd/herd.h"
#include "skitter/decode.h"

// Where the bones of a leg are, from downloaded poses, whatever the controller poses.
namespace skitter::crowd {

// Relative to the body's position, along world axes. `bone` is one of the leg's own.
BonePose placedBone(const HerdState& state, const Kind& kind, size_t agent, size_t leg, size_t bone);
// Where the leg's last bone ends, likewise.
glm::vec3 placedTip(const HerdState& state, const Kind& kind, size_t agent, size_t leg);

}  // namespace skitter::crowd

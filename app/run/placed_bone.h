#pragma once

#include <cstddef>

#include "crowd/herd.h"

namespace skitter::app {

// Where a bone starts, relative to the body along world axes, and its rotation from rest, xyzw.
struct PlacedBone {
  float start[3], rotation[4];
};

// `agent` is a number in `state`, of an agent of `kind`; the leg has that bone. The state has poses.
PlacedBone placedBone(const HerdState& state, const crowd::Kind& kind, size_t agent, size_t leg, size_t bone);

}  // namespace skitter::app

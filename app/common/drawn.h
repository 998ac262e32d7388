#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "crowd/herd.h"
#include "laws/creature.h"
#include "skitter/crowd.h"
#include "skitter/decode.h"

namespace skitter::app {

// The creature, as laws/ knows it, that agents of a kind are drawn as.
laws::Creature drawnCreature(const crowd::Kind& kind);

// The transforms that an agent of the kind is drawn with, world from rest. `agent` is a number in `state`.
// Where there are no pose records, they follow from directions of bones, and are empty for controllers that
// play clips.
std::vector<glm::dmat4x3> drawnBones(const HerdState& state, const crowd::Kind& kind, size_t agent,
                                     const BodyState& body);

// The record of an agent or a leg.
std::span<const float> recordOf(const std::vector<float>& records, size_t number, int stride);

}  // namespace skitter::app

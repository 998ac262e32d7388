#pragma once

#include <glm/glm.hpp>

#include "skitter/rig.h"

namespace skitter {

// Bends a leg at rest, skin and all, so that its middle goes the way of `direction` (model space) and a
// straight leg of two bones has `degrees` at its middle. Its root stays, its foot comes nearer; its home is
// left alone.
void bendLeg(Rig& rig, size_t leg, const glm::dvec3& direction, double degrees);

// Brings a leg's foot to its home at rest, skin and all: its last `footBones` bones keep their direction, the
// others bend more or less as they do, or toward `direction` unless that is 0. A home out of reach is
// approached.
void settleLeg(Rig& rig, size_t leg, size_t footBones, const glm::dvec3& direction);

}  // namespace skitter

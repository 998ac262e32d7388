#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <span>

#include "crowd/herd.h"

// Where downloaded records say that agents and their legs are.
namespace skitter::crowd {

// World metres.
glm::dvec3 bodyPosition(const HerdState& state, size_t agent);
// World from model.
glm::quat bodyRotation(const HerdState& state, size_t agent);

struct PlacedBone {
  glm::vec3 start{0};              // relative to the body's position, world axes, metres
  glm::quat rotation{1, 0, 0, 0};  // world from rest
};
// The state has poses. `bone` is one of the leg's own.
PlacedBone placedBone(const HerdState& state, const Kind& kind, size_t agent, size_t leg, size_t bone);
// Where the leg's last bone ends, relative to the body's position as posed.
glm::vec3 placedTip(const HerdState& state, const Kind& kind, size_t agent, size_t leg);

}  // namespace skitter::crowd

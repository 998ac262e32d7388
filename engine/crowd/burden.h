#pragma once

#include <glm/glm.hpp>

#include "crowd/regait.h"

namespace skitter::crowd {

// What an agent carries.
struct Burden {
  float share = 0;      // of the agent's own mass, 0 to mostShare
  glm::vec3 offset{0};  // of the load's centre from the body's, model space, leg lengths

  static constexpr float mostShare = 4;
};

// The centre of mass of body and load, from the body's, in leg lengths.
glm::vec3 combinedCentre(const Burden& burden);

// The gait of an agent that carries: slower, lower, with its feet below the combined centre, and with steps
// that last shorter, so that feet stand for longer. `gait` itself where the share is 0.
Regait burdened(const Regait& gait, const Burden& burden, float legLength, float bodyHeight);

}  // namespace skitter::crowd

#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>

#include "crowd/regait.h"
#include "skitter/records.h"
#include "skitter/scene.h"

namespace skitter::crowd {

// The centre of mass of body and load, from the body's, in leg lengths.
glm::vec3 combinedCentre(const Load& load);

// The gait of an agent that carries: slower, lower, and with its feet below the combined centre. `gait`,
// which is that of the pattern, itself where the mass is 0, and where the agent lies on its belly.
Regait loaded(const Regait& gait, const Load& load, const Rig& rig, const Tuning& tuning,
              const LegPattern& pattern);

// The agent's `carried` record, and what it says.
using CarriedRecord = std::array<float, 4 * shared::CARRIED_STRIDE>;
CarriedRecord carriedRecord(const Load& load);
Load loadOf(std::span<const float> record);

}  // namespace skitter::crowd

#pragma once

#include <optional>

#include "cpu_reference/types.h"

namespace skitter::reference {

// What a foot of a planted clip remembers.
struct Plant {
  double tileX = 0, tileZ = 0;
  glm::dvec3 lock{0};    // local to the tile in x and z, world in y
  glm::dvec3 offset{0};  // o, world axes
  bool locked = false;

  glm::dvec3 relative(const AgentBody& body) const {
    return {(tileX - body.tileX) * tileSize + (lock.x - body.localX), lock.y - body.y,
            (tileZ - body.tileZ) * tileSize + (lock.z - body.localZ)};
  }
};

struct PlantedFoot {
  Foot foot;
  Plant plant;
  glm::dvec3 wanted{0};    // W, relative
  double strayMargin = 0;  // metres between |o.xz| and the bound that it was held against; infinite: none
};

// A leg that does not carry has no target, and no lock.
PlantedFoot idlePlantedFoot(const Plant& previous);

// `inModel` is the clip's foot, p_bones, and `stands` whether it stands there; `locked`, if any, is the
// decision instead of the rule's.
PlantedFoot plantedSwing(const Tuning& tuning, const Heights& heights, const AgentBody& body,
                         const glm::dvec3& inModel, bool stands, const Plant& previous,
                         const std::optional<bool>& locked = {});

}  // namespace skitter::reference

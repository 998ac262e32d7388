#pragma once

#include "cpu_reference/stages/ik.h"

namespace skitter::reference {

// Where a planted leg is solved from: the clip's.
struct PlantedStart {
  std::vector<glm::dvec2> directions;
  glm::dvec3 root{0};  // model space
};

// K x = turn x + move, model space: what brings a bone from the clip's pose to the solved one.
struct BoneFix {
  glm::dmat3 turn{1};
  glm::dvec3 move{0};
};

// What ik is given: the limb from the clip's root on, its cones as wide as the clip has them at least.
Limb plantedLimb(const Limb& limb, const PlantedStart& start);

Chain plantedIk(const Tuning& tuning, const Limb& limb, const AgentBody& body, const Foot& foot,
                const PlantedStart& start, const IkPlan& plan);

// One a bone.
std::vector<BoneFix> boneFixes(const Limb& limb, const PlantedStart& start,
                               const std::vector<glm::dvec2>& solved);

}  // namespace skitter::reference

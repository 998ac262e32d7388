#pragma once

#include <vector>

#include "cpu_reference/types.h"

namespace skitter::reference {

// An agent's damage, and the gait that it has for it (docs/damage.md).
struct Hurt {
  struct Turn {
    double group = 0;  // with what its turn begins after that of its group, in turns
    double lag = 0;
    uint32_t neighbours = 0;
    double slowness = 1;
    size_t lostFrom = 0;  // the first bone that is lost, of a lost leg
  };
  uint32_t lost = 0, stuck = 0, lame = 0;  // masks of legs
  int groups = 1;
  glm::dvec3 shift{0};  // of the homes, model space
  double speed = 1;
  std::vector<Turn> legs;
};

// The creature that such an agent is.
Creature hurtCreature(const Creature& whole, const Hurt& hurt);

// Where the centre of mass of a body, which is at 0 and has mass 1, is with a load of that mass at that
// place.
glm::dvec3 centreWith(double mass, const glm::dvec3& place);

// A leg that does not carry has no target, and keeps its pose.
Foot idleFoot();
Chain heldLeg(const Limb& limb, const AgentBody& body, const Chain& previous);

}  // namespace skitter::reference

#include "cpu_reference/stages/hurt.h"

#include "cpu_reference/ik/kinematics.h"

namespace skitter::reference {

Creature hurtCreature(const Creature& whole, const Hurt& hurt) {
  Creature creature = whole;
  creature.groups = hurt.groups;
  creature.shift = hurt.shift;
  creature.speed = hurt.speed;
  for (size_t l = 0; l < creature.limbs.size(); ++l) {
    Limb& limb = creature.limbs[l];
    const Hurt::Turn& turn = hurt.legs[l];
    limb.home += hurt.shift;
    limb.group = turn.group;
    limb.lag = turn.lag;
    limb.neighbours = turn.neighbours;
    limb.slowness = turn.slowness;
    limb.lost = (hurt.lost >> l & 1u) != 0;
    limb.carries = ((hurt.lost | hurt.stuck) >> l & 1u) == 0;
    if (limb.lost) limb.left = turn.lostFrom;
  }
  return creature;
}

glm::dvec3 centreWith(double mass, const glm::dvec3& place) { return mass * place / (1 + mass); }

Foot idleFoot() { return {.target = glm::dvec3(0), .progress = 0}; }

Chain heldLeg(const Limb& limb, const AgentBody& body, const Chain& previous) {
  Chain held;
  held.directions = previous.directions;
  held.tip = body.orientation * (limb.root + limb.reach * Posture(limb, previous.directions).tip());
  return held;
}

}  // namespace skitter::reference

#include "cpu_reference/stages/ik_planted.h"

#include "cpu_reference/rotation.h"

namespace skitter::reference {

Limb plantedLimb(const Limb& limb, const PlantedStart& start) {
  Limb moved = limb;
  moved.root = start.root;
  for (size_t i = 0; i < moved.bones.size(); ++i) {
    // What was animated is allowed, whatever the rig's limits are.
    moved.bones[i].tanHalfCone = std::max(moved.bones[i].tanHalfCone, glm::length(start.directions[i]));
  }
  return moved;
}

Chain plantedIk(const Tuning& tuning, const Limb& limb, const AgentBody& body, const Foot& foot,
                const PlantedStart& start, const IkPlan& plan) {
  Chain clips;
  clips.directions = start.directions;
  return ik(tuning, plantedLimb(limb, start), body, foot, clips, plan);
}

std::vector<BoneFix> boneFixes(const Limb& limb, const PlantedStart& start,
                               const std::vector<glm::dvec2>& solved) {
  const Posture played(limb, start.directions), found(limb, solved);
  std::vector<BoneFix> fixes;
  for (size_t i = 0; i < limb.bones.size(); ++i) {
    const glm::dvec3 along = limb.bones[i].along;
    BoneFix fix;
    fix.turn = shortest(normalized(played.turned(i) * along), normalized(found.turned(i) * along));
    const glm::dvec3 from = start.root + limb.reach * played.joint(i);
    const glm::dvec3 to = start.root + limb.reach * found.joint(i);
    fix.move = to - fix.turn * from;
    fixes.push_back(fix);
  }
  return fixes;
}

}  // namespace skitter::reference

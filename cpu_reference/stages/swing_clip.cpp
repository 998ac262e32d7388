#include "cpu_reference/stages/swing_clip.h"

#include "cpu_reference/clips/blend.h"
#include "cpu_reference/ik/kinematics.h"

namespace skitter::reference {

ClipLeg clipLeg(const ClipTable& table, const Limb& limb, size_t leg, const Play& play) {
  ClipLeg result;
  result.joints = blendedJoints(table, play, leg);
  result.stands = standsInClip(table, play, leg);
  Posture posture(limb, std::vector(limb.bones.size(), glm::dvec2(0)));
  for (size_t i = 0; i < limb.bones.size(); ++i) {
    const glm::dvec3 along = normalized(result.joints[i + 1] - result.joints[i]);
    const glm::dvec3 d = glm::transpose(posture.frame(i)) * along;
    result.divisors.push_back(1 + std::max(d.z, -0.999));
    posture.place(i, glm::dvec2(d) / result.divisors[i]);
  }
  result.directions = posture.directions();
  return result;
}

ClipFoot clipSwing(const ClipTable& table, const Limb& limb, size_t leg, const AgentBody& body,
                   const Play& play) {
  const ClipLeg played = clipLeg(table, limb, leg, play);
  ClipFoot result;
  result.foot = {body.orientation * played.joints.back(), played.stands ? 1 : 0.5};
  result.chain.directions = played.directions;
  result.chain.tip = result.foot.target;
  return result;
}

}  // namespace skitter::reference

#include "cpu_reference/ik.h"

#include <algorithm>

#include "cpu_reference/active_set.h"
#include "cpu_reference/fabrik.h"

namespace skitter::reference {
namespace {

bool isStraight(const Posture& posture) {
  const glm::dvec3 line = normalized(posture.tip());
  for (size_t i = 1; i < posture.bones(); ++i) {
    const glm::dvec3& joint = posture.joint(i);
    if (glm::length(joint - line * glm::dot(joint, line)) >= 1e-3) return false;
  }
  return true;
}

// A straight chain whose target lies nearer along it is a saddle that neither solver can leave.
void breakDeadlock(const Limb& limb, const glm::dvec3& target, Posture& posture) {
  if (!isStraight(posture) || glm::length(target) >= 0.999 * glm::length(posture.tip())) return;
  for (size_t i = 0; i < posture.bones(); ++i) {
    const glm::dvec2 xy =
        posture.directions()[i] +
        glm::dvec2(i == 0 ? -0.025 * static_cast<double>(posture.directions().size() - 1) : 0.05, 0);
    posture.place(i, clampCone(xy, limb.bones[i].tanHalfCone));
  }
}

}  // namespace

glm::dvec3 ikTarget(const Limb& limb, const AgentBody& body, const glm::dvec3& foot) {
  return (glm::conjugate(body.orientation) * foot - limb.root) / limb.reach;
}

Chain ik(const Tuning& tuning, const Limb& limb, const AgentBody& body, const Foot& foot,
         const Chain& previous, int fabrikIterations, int polishIterations) {
  Chain chain = previous;
  Posture posture(limb, previous.directions);
  glm::dvec3 target = ikTarget(limb, body, foot.target);
  const bool finite = std::isfinite(target.x) && std::isfinite(target.y) && std::isfinite(target.z);
  if (!finite) target = posture.tip();
  chain.errorBefore = glm::length(target - posture.tip()) * limb.reach;
  if (finite) {
    breakDeadlock(limb, target, posture);
    fabrik(limb, target, fabrikIterations, tuning.fabrikError, posture);
    if (polishIterations > 0) activeSet(tuning, limb, target, polishIterations - 1, posture, chain.damping);
  }
  chain.directions = posture.directions();
  chain.tip = body.orientation * (limb.root + limb.reach * posture.tip());
  chain.reachError = glm::length(target - posture.tip()) * limb.reach;
  return chain;
}

}  // namespace skitter::reference

#include "cpu_reference/measure.h"

#include <algorithm>

#include "cpu_reference/heightfield.h"

namespace skitter::reference {

Metric measure(const Heights& heights, const Limb& limb, const AgentBody& body, const Step& step,
               const Foot& foot, const Chain& chain, const Metric& previous) {
  Metric next = previous;
  const bool planted = foot.progress >= 1;
  const bool plantedBefore = previous.slip >= 0;
  next.previousTip = {(body.tileX - step.tileX) * tileSize + body.localX + chain.tip.x, body.y + chain.tip.y,
                      (body.tileZ - step.tileZ) * tileSize + body.localZ + chain.tip.z};

  if (planted) {
    next.slip = plantedBefore ? previous.slip + std::hypot(next.previousTip.x - previous.previousTip.x,
                                                           next.previousTip.z - previous.previousTip.z)
                              : 0;
  } else {
    if (plantedBefore) {
      next.finishedSlip += previous.slip;
      next.finishedStances += 1;
    }
    next.slip = -1;
  }

  const glm::dvec2 position = body.world();
  const double ground = heightAt(heights, position.x + chain.tip.x, position.y + chain.tip.z);
  const double above = body.y + chain.tip.y - ground;
  next.penetration += std::max(0.0, -above);
  if (planted) next.floating += std::max(0.0, above);
  next.ticks += 1;
  if (planted) next.stanceTicks += 1;
  next.largestError = std::max(next.largestError, chain.reachError);
  for (size_t i = 0; i < limb.bones.size(); ++i) {
    const double t = limb.bones[i].tanHalfCone;
    next.largestViolation =
        std::max(next.largestViolation, 2 * (glm::length(chain.directions[i]) - t) / (1 + t * t));
  }
  return next;
}

}  // namespace skitter::reference

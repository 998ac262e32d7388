#include "assets/rigs/limb_pairs.h"

#include <fmt/format.h>

#include <algorithm>

#include "skitter/rig.h"

namespace skitter {

void pairLimbs(BodyPlan& plan) {
  plan.middle = 0;
  for (const Limb& limb : plan.limbs)
    plan.middle += glm::dot(limb.tip, plan.left) / static_cast<double>(plan.limbs.size());
  std::vector<bool> paired(plan.limbs.size(), false);
  for (size_t a = 0; a < plan.limbs.size(); ++a) {
    if (paired[a]) continue;
    const glm::dvec3 image =
        plan.limbs[a].tip - plan.left * (2 * (glm::dot(plan.limbs[a].tip, plan.left) - plan.middle));
    size_t best = a;
    double nearest = 0.25 * plan.limbs[a].reach;
    for (size_t b = a + 1; b < plan.limbs.size(); ++b) {
      if (paired[b] || (glm::dot(plan.limbs[b].tip, plan.left) > plan.middle) ==
                           (glm::dot(plan.limbs[a].tip, plan.left) > plan.middle)) {
        continue;
      }
      const double apart = glm::length(plan.limbs[b].tip - image);
      if (apart > nearest) continue;
      nearest = apart;
      best = b;
    }
    if (best == a) continue;
    paired[a] = paired[best] = true;
    // Mirrored feet end alike.
    if (plan.limbs[a].footJoint == plan.limbs[best].footJoint) continue;
    for (Limb* limb : {&plan.limbs[a], &plan.limbs[best]}) {
      if (!limb->footJoint && limb->boneCount() > 2) limb->endAtJoint(plan.model);
    }
  }
  if (std::find(paired.begin(), paired.end(), true) == paired.end()) return;
  std::vector<Limb> kept;
  for (size_t i = 0; i < plan.limbs.size(); ++i) {
    if (paired[i]) {
      kept.push_back(plan.limbs[i]);
    } else {
      plan.note(fmt::format("the chain from {} has no mirror image: left out",
                            plan.model.reference(plan.limbs[i].root())));
    }
  }
  plan.limbs = std::move(kept);
}

std::vector<LimbName> nameLimbs(BodyPlan& plan) {
  std::stable_sort(plan.limbs.begin(), plan.limbs.end(), [&](const Limb& a, const Limb& b) {
    return glm::dot(a.tip, plan.forward) > glm::dot(b.tip, plan.forward);
  });
  std::vector<LimbName> names;
  std::vector<Limb> sides[2];
  for (Limb& limb : plan.limbs)
    sides[glm::dot(limb.tip, plan.left) > plan.middle ? 0 : 1].push_back(std::move(limb));
  plan.limbs.clear();
  for (size_t row = 0; row < std::max(sides[0].size(), sides[1].size()); ++row) {
    for (size_t side = 0; side < 2; ++side) {
      if (row >= sides[side].size()) continue;
      names.push_back(
          {fmt::format("{}{}", side == 0 ? 'L' : 'R', row + 1), (row + side) % 2 == 0 ? "A" : "B"});
      plan.limbs.push_back(std::move(sides[side][row]));
    }
  }
  return names;
}

bool canWalk(BodyPlan& plan) {
  if (plan.limbs.size() < 2) plan.note("one leg cannot walk");
  if (plan.limbs.size() > Rig::maxLegs)
    plan.note(fmt::format("{} legs, expected at most {}", plan.limbs.size(), Rig::maxLegs));
  const auto tooLong = [](const Limb& limb) { return limb.boneCount() > Leg::maxBones; };
  const auto longLimb = std::find_if(plan.limbs.begin(), plan.limbs.end(), tooLong);
  if (longLimb != plan.limbs.end()) {
    plan.note(fmt::format("the leg from {} has {} bones, expected at most {}",
                          plan.model.reference(longLimb->root()), longLimb->boneCount(), Leg::maxBones));
  }
  return plan.limbs.size() >= 2 && plan.limbs.size() <= Rig::maxLegs && longLimb == plan.limbs.end();
}

}  // namespace skitter

#include "assets/rigs/foot_homes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace skitter {
namespace {

constexpr double standShare = 0.75;  // of the reach, root to home: no leg stands straighter
constexpr double strideShare = 0.3;  // of the longest reach: half the longest stride (crowd/tuning.cpp)
constexpr double strideApart =
    0.1;  // of the reach: feet of a pair further from mirrored places are in mid-stride
constexpr double stretchShare = 0.95;  // of the reach, root to foot: a leg stretched further steps at once

// Brings homes nearer to their roots where the foot could not go ahead of or behind its home by half a
// stride. Legs that point along the way would else be pulled straight at the end of each stance.
void drawIn(const BodyPlan& plan, double ground, std::vector<glm::dvec3>& homes) {
  double longest = 0;
  for (const Limb& limb : plan.limbs) longest = std::max(longest, limb.reach);
  const double half = strideShare * longest;
  for (size_t i = 0; i < plan.limbs.size(); ++i) {
    const glm::dvec3 root = plan.at(plan.limbs[i].root()), out = homes[i] - plan.flat(root);
    const double drop = plan.height(root) - ground, most = stretchShare * plan.limbs[i].reach;
    // (s out + half forward)^2 + drop^2 = most^2, forward to the side where out points.
    const double a = glm::dot(out, out), b = half * std::fabs(glm::dot(out, plan.forward));
    const double c = half * half + drop * drop - most * most;
    if (a + 2 * b + c <= 0) continue;
    const double share = (std::sqrt(std::max(0.0, b * b - a * c)) - b) / std::max(a, 1e-12);
    homes[i] = plan.flat(root) + out * std::max(0.0, share);
  }
}

// In a model that rests in mid-stride one foot of a pair is ahead of the other: both stand amid that.
void mirrorPairs(BodyPlan& plan, std::vector<glm::dvec3>& homes) {
  const auto image = [&](const glm::dvec3& p) {
    return p - plan.left * (2 * (glm::dot(p, plan.left) - plan.middle));
  };
  for (size_t a = 0; a < plan.limbs.size(); ++a) {
    for (size_t b = a + 1; b < plan.limbs.size(); ++b) {
      if (plan.limbs[a].pair == -1 || plan.limbs[a].pair != plan.limbs[b].pair) continue;
      if (glm::length(image(homes[b]) - homes[a]) < strideApart * plan.limbs[a].reach) continue;
      homes[a] = 0.5 * (homes[a] + image(homes[b]));
      homes[b] = image(homes[a]);
      plan.limbs[a].strides = plan.limbs[b].strides = true;
    }
  }
}

}  // namespace

FootHomes placeFeet(BodyPlan& plan) {
  FootHomes feet;
  std::vector<glm::dvec3>& homes = feet.homes;
  double ground = 0;
  for (const Limb& limb : plan.limbs)
    ground += plan.height(limb.tip) / static_cast<double>(plan.limbs.size());
  const double rest = ground;
  for (const Limb& limb : plan.limbs) {
    const glm::dvec3 root = plan.at(limb.root());
    glm::dvec3 out = plan.flat(limb.tip) - plan.flat(root);
    const double most = 0.9 * standShare * limb.reach;
    if (glm::length(out) > most) out *= most / glm::length(out);
    homes.push_back(plan.flat(root) + out);
    const double stand = standShare * limb.reach;
    const double drop = std::sqrt(std::max(0.0, stand * stand - glm::dot(out, out)));
    ground = std::max(ground, plan.height(root) - drop);
  }
  const double lowered = ground - rest;
  mirrorPairs(plan, homes);
  drawIn(plan, ground, homes);
  glm::dvec3 centre(0);
  for (glm::dvec3& home : homes) {
    home += plan.up * ground;
    centre += home / static_cast<double>(homes.size());
  }
  feet.origin = centre + plan.left * (plan.middle - glm::dot(centre, plan.left));
  if (lowered > 1e-6) {
    plan.note(fmt::format(
        "the legs rest straight or wide: the ground is {:.3g} units above the feet at rest, so that "
        "they stand bent",
        lowered));
  }
  return feet;
}

}  // namespace skitter

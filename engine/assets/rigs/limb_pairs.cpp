#include "assets/rigs/limb_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assets/rigs/joint_names.h"
#include "skitter/rig.h"

namespace skitter {

namespace {

constexpr double rootApart =
    0.25;  // of the reach: a partner leaves the body no further from the mirrored place
constexpr double tipApart = 0.25;     // of the reach: so near to it a foot's image tells a partner, too
constexpr double builtAlike = 0.15;   // of the reach: lengths of bones that differ by less are of one kind
constexpr double middleShare = 0.05;  // of the reach: so near to the middle a limb is on neither side
constexpr double armHeight = 1.25;    // of the legs' roots' height: arms leave the body above it

double reachOf(const Limb& a, const Limb& b) { return std::max({a.reach, b.reach, 1e-9}); }

// How much two limbs differ in their bones, a share of the reach. What follows the last joint may differ: one
// foot of a pair may have a joint that the other lacks.
double unlike(const BodyPlan& plan, const Limb& a, const Limb& b) {
  const size_t bones = std::min(a.joints.size() - a.inBody, b.joints.size() - b.inBody) - 1;
  const size_t most = std::max(a.joints.size() - a.inBody, b.joints.size() - b.inBody) - 1;
  double sum = std::fabs(a.reach - b.reach);
  for (size_t k = 0; k < bones; ++k) {
    const auto length = [&](const Limb& limb) {
      const size_t j = limb.inBody + k;
      return glm::length(plan.at(limb.joints[j + 1]) - plan.at(limb.joints[j]));
    };
    sum += std::fabs(length(a) - length(b));
  }
  return sum / reachOf(a, b) + 0.1 * static_cast<double>(most - bones);
}

glm::dvec3 imageOf(const BodyPlan& plan, const glm::dvec3& p) {
  return p - plan.left * (2 * (glm::dot(p, plan.left) - plan.middle));
}

// The middle on which most pairs of limbs agree that are built alike.
double middleOf(const BodyPlan& plan) {
  struct Candidate {
    double at, tolerance;
  };
  std::vector<Candidate> candidates;
  double mean = 0;
  for (size_t a = 0; a < plan.limbs.size(); ++a) {
    const Limb& limb = plan.limbs[a];
    mean += glm::dot(limb.tip, plan.left) / static_cast<double>(plan.limbs.size());
    for (size_t b = a + 1; b < plan.limbs.size(); ++b) {
      const Limb& other = plan.limbs[b];
      const glm::dvec3 from = plan.at(limb.root()), to = plan.at(other.root());
      const glm::dvec3 apart = from - to;
      const double reach = reachOf(limb, other);
      if (glm::length(apart - plan.left * glm::dot(apart, plan.left)) > rootApart * reach) continue;
      if (unlike(plan, limb, other) > builtAlike) continue;
      candidates.push_back({0.5 * glm::dot(from + to, plan.left), middleShare * reach});
    }
  }
  double best = mean;
  size_t most = 0;
  for (const Candidate& candidate : candidates) {
    size_t count = 0;
    double sum = 0;
    for (const Candidate& other : candidates) {
      if (std::fabs(other.at - candidate.at) > candidate.tolerance) continue;
      ++count;
      sum += other.at;
    }
    if (count < most || (count == most && std::fabs(candidate.at - mean) >= std::fabs(best - mean))) continue;
    most = count;
    best = sum / static_cast<double>(count);
  }
  return best;
}

// How badly two limbs match as a pair; HUGE_VAL: not at all.
double mismatch(const BodyPlan& plan, const Limb& a, const Limb& b) {
  const double reach = reachOf(a, b);
  const auto across = [&](const glm::dvec3& p) { return glm::dot(p, plan.left) - plan.middle; };
  if (across(a.tip) * across(b.tip) >= 0) return HUGE_VAL;
  const double roots = glm::length(imageOf(plan, plan.at(a.root())) - plan.at(b.root())) / reach;
  const double tips = glm::length(imageOf(plan, a.tip) - b.tip) / reach;
  const double bones = unlike(plan, a, b);
  if (tips > tipApart && (roots > rootApart || bones > builtAlike)) return HUGE_VAL;
  return roots + bones + 0.3 * std::min(tips, 1.0);
}

}  // namespace

void dropNamedLimbs(BodyPlan& plan) {
  const auto ground = [&] {
    double least = HUGE_VAL;
    for (const Limb& limb : plan.limbs) least = std::min(least, plan.height(limb.tip));
    return least;
  }();
  // Arms leave the body above the legs; forelegs may be called arms, too.
  double legs = 0;
  size_t count = 0;
  for (const Limb& limb : plan.limbs) {
    if (hasWord(wordsOf(plan.model, limb.chain), armWords)) continue;
    legs += plan.height(plan.at(limb.root())) - ground;
    ++count;
  }
  const auto whatIs = [&](const Limb& limb) -> const char* {
    const std::vector<std::string> words = wordsOf(plan.model, limb.chain);
    if (hasWord(words, fingerWords)) return "a finger";
    if (hasWord(words, heldWords)) return "something held";
    if (hasWord(words, looseWords)) return "a tail, a wing or the like";
    const double root = plan.height(plan.at(limb.root())) - ground;
    if (count >= 2 && hasWord(words, armWords) && root * static_cast<double>(count) > armHeight * legs)
      return "an arm";
    return nullptr;
  };
  std::vector<Limb> kept;
  for (const Limb& limb : plan.limbs) {
    const char* what = whatIs(limb);
    if (!what)
      kept.push_back(limb);
    else
      plan.note(fmt::format("the chain from {} is {} by its joints' names: left out",
                            plan.model.reference(limb.root()), what));
  }
  plan.limbs = std::move(kept);
}

namespace {

// Gives the limbs of each pair one number; how many pairs there are.
int matchPairs(BodyPlan& plan) {
  plan.middle = middleOf(plan);
  struct Match {
    double cost;
    size_t a, b;
  };
  std::vector<Match> matches;
  for (size_t a = 0; a < plan.limbs.size(); ++a) {
    plan.limbs[a].pair = -1;
    for (size_t b = a + 1; b < plan.limbs.size(); ++b) {
      const double cost = mismatch(plan, plan.limbs[a], plan.limbs[b]);
      if (cost < HUGE_VAL) matches.push_back({cost, a, b});
    }
  }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const Match& x, const Match& y) { return x.cost < y.cost; });
  int pairs = 0;
  for (const Match& match : matches) {
    Limb &a = plan.limbs[match.a], &b = plan.limbs[match.b];
    if (a.pair == -1 && b.pair == -1) a.pair = b.pair = pairs++;
  }
  return pairs;
}

}  // namespace

Pairing pairingAcross(const BodyPlan& plan, const glm::dvec3& side) {
  BodyPlan across = plan;
  across.left = side;
  const double share = 2.0 * matchPairs(across) / static_cast<double>(std::max<size_t>(plan.limbs.size(), 1));
  return {.share = share, .middle = across.middle};
}

void pairLimbs(BodyPlan& plan) {
  const int pairs = matchPairs(plan);
  for (Limb& a : plan.limbs) {
    for (Limb& b : plan.limbs) {
      // Mirrored feet end alike.
      if (a.pair == -1 || a.pair != b.pair || a.footJoint == b.footJoint) continue;
      for (Limb* limb : {&a, &b}) {
        if (!limb->footJoint && limb->boneCount() > 2) limb->endAtJoint(plan.model);
      }
    }
  }
  if (pairs == 0) return;
  std::vector<Limb> kept;
  for (const Limb& limb : plan.limbs) {
    const bool leg =
        limb.pair != -1 || std::any_of(plan.limbs.begin(), plan.limbs.end(), [&](const Limb& other) {
          return other.pair != -1 && other.boneCount() == limb.boneCount() &&
                 unlike(plan, limb, other) < builtAlike;
        });
    if (leg) {
      kept.push_back(limb);
    } else {
      plan.note(fmt::format("the chain from {} has no mirror image and is not built like a leg: left out",
                            plan.model.reference(limb.root())));
    }
  }
  plan.limbs = std::move(kept);
}

std::vector<LimbName> nameLimbs(BodyPlan& plan) {
  std::stable_sort(plan.limbs.begin(), plan.limbs.end(), [&](const Limb& a, const Limb& b) {
    return glm::dot(a.tip, plan.forward) > glm::dot(b.tip, plan.forward);
  });
  std::vector<LimbName> names;
  std::vector<Limb> sides[2], between;
  for (Limb& limb : plan.limbs) {
    const double across = glm::dot(limb.tip, plan.left) - plan.middle;
    if (limb.pair == -1 && std::fabs(across) < middleShare * limb.reach)
      between.push_back(std::move(limb));
    else
      sides[across > 0 ? 0 : 1].push_back(std::move(limb));
  }
  plan.limbs.clear();
  for (size_t row = 0; row < std::max(sides[0].size(), sides[1].size()); ++row) {
    for (size_t side = 0; side < 2; ++side) {
      if (row >= sides[side].size()) continue;
      names.push_back(
          {fmt::format("{}{}", side == 0 ? 'L' : 'R', row + 1), (row + side) % 2 == 0 ? "A" : "B"});
      plan.limbs.push_back(std::move(sides[side][row]));
    }
  }
  for (size_t k = 0; k < between.size(); ++k) {
    names.push_back({fmt::format("M{}", k + 1), k % 2 == 0 ? "A" : "B"});
    plan.limbs.push_back(std::move(between[k]));
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

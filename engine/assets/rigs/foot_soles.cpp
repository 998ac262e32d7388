#include "assets/rigs/foot_soles.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace skitter {
namespace {

constexpr double ankleShare = 0.18;  // of the reach: an ankle is no higher above the sole
constexpr double topShare = 0.35;    // of the reach: a foot's skin reaches no higher above the sole
constexpr double soleShare = 0.06;   // of the reach: half the length of a foot that is no point
constexpr double patchShare = 0.04;  // of the reach: skin so near to the lowest lies on the ground
constexpr double leastShare = 0.03;  // of the reach: a shorter foot has no bone of its own

struct Sole {
  size_t ankle = 0;  // into Limb::joints
  glm::dvec3 middle{0}, toes{0};
  bool wide = false;
};

class SoleFinder {
 public:
  SoleFinder(const BodyPlan& plan, const Limb& limb) : plan_(plan), limb_(limb) {}

  std::optional<Sole> find() const {
    for (size_t k = limb_.inBody + 1; k < limb_.joints.size(); ++k) {
      // A foot outside the chain begins at the joint that it hangs from.
      const bool outside =
          !plan_.model.isAncestor(limb_.joints[limb_.joints.size() - 2], limb_.joints.back());
      if (outside && k + 1 < limb_.joints.size()) continue;
      const std::vector<glm::dvec3> skin = skinFrom(k);
      if (skin.empty()) continue;
      const glm::dvec3 ankle = plan_.at(limb_.joints[k]);
      double low = HUGE_VAL, high = -HUGE_VAL;
      for (const glm::dvec3& p : skin) {
        low = std::min(low, plan_.height(p));
        high = std::max(high, plan_.height(p));
      }
      // The low knee of a leg that rises once more is no ankle.
      if (plan_.height(ankle) - low > ankleShare * limb_.reach || high - low > topShare * limb_.reach)
        continue;
      Sole sole{.ankle = k};
      sole.wide = halfLength(skin) > soleShare * limb_.reach;
      std::vector<glm::dvec3> patch;
      for (const glm::dvec3& p : skin) {
        if (plan_.height(p) <= low + patchShare * limb_.reach) patch.push_back(p);
      }
      sole.middle = middleOf(patch) + plan_.up * low;
      sole.toes = middleOf(skin) - plan_.flat(ankle);
      if (glm::length(sole.middle - ankle) < leastShare * limb_.reach) return {};
      return sole;
    }
    return {};
  }

 private:
  // What follows a joint of the leg or a joint below it.
  std::vector<glm::dvec3> skinFrom(size_t k) const {
    std::vector<glm::dvec3> points;
    for (size_t i = 0; i < plan_.skin.size(); ++i) {
      if (plan_.skin[i].empty()) continue;
      const auto follows = [&](int joint) {
        return joint == static_cast<int>(i) || plan_.model.isAncestor(joint, static_cast<int>(i));
      };
      if (!std::any_of(limb_.joints.begin() + static_cast<std::ptrdiff_t>(k), limb_.joints.end(), follows))
        continue;
      for (const size_t v : plan_.skin[i]) points.push_back(plan_.model.vertices[v].position);
    }
    return points;
  }

  glm::dvec3 middleOf(const std::vector<glm::dvec3>& points) const {
    glm::dvec3 least(HUGE_VAL), most(-HUGE_VAL);
    for (const glm::dvec3& p : points) {
      least = glm::min(least, plan_.flat(p));
      most = glm::max(most, plan_.flat(p));
    }
    return 0.5 * (least + most);
  }

  double halfLength(const std::vector<glm::dvec3>& points) const {
    const glm::dvec3 middle = middleOf(points);
    double most = 0;
    for (const glm::dvec3& p : points) most = std::max(most, glm::length(plan_.flat(p) - middle));
    return most;
  }

  const BodyPlan& plan_;
  const Limb& limb_;
};

}  // namespace

void findSoles(BodyPlan& plan) {
  std::vector<std::optional<Sole>> soles;
  for (const Limb& limb : plan.limbs) soles.push_back(SoleFinder(plan, limb).find());
  for (size_t i = 0; i < plan.limbs.size(); ++i) {
    if (!soles[i]) continue;
    // Mirrored feet end alike: one that is wide makes its partner's wide, one that is none makes neither.
    bool wide = soles[i]->wide;
    bool both = true;
    for (size_t j = 0; j < plan.limbs.size(); ++j) {
      if (j == i || plan.limbs[i].pair == -1 || plan.limbs[j].pair != plan.limbs[i].pair) continue;
      both = soles[j].has_value();
      wide = wide || (both && soles[j]->wide);
    }
    Limb& limb = plan.limbs[i];
    if (!wide || !both) continue;
    limb.joints.resize(soles[i]->ankle + 1);
    limb.tip = soles[i]->middle;
    limb.footJoint = false;
    limb.sole = true;
    limb.toes = soles[i]->toes;
    limb.measure(plan.model);
  }
}

}  // namespace skitter

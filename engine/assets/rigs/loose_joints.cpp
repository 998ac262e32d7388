#include "assets/rigs/loose_joints.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "assets/rigs/joint_names.h"

namespace skitter {
namespace {

constexpr double onBoneShare = 0.04;  // of the reach: a joint so near to a bone rests on it
constexpr double hipShare = 0.15;     // of the reach: so near to the hip joints are the body's

double distanceTo(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& p) {
  const glm::dvec3 way = b - a;
  const double square = glm::dot(way, way);
  const double share = square > 0 ? std::clamp(glm::dot(p - a, way) / square, 0.0, 1.0) : 0;
  return glm::length(p - (a + way * share));
}

class FollowerFinder {
 public:
  explicit FollowerFinder(const BodyPlan& plan) : plan_(plan), bone_(plan.model.nodes.size(), -1) {
    for (const Limb& limb : plan.limbs) {
      const std::vector<glm::dvec3> points = plan.pointsOf(limb);
      for (size_t j = limb.inBody; j < limb.joints.size(); ++j) {
        // The last joint has a bone only where the foot is beyond it.
        const size_t bone = std::min(j, limb.inBody + points.size() - 2);
        bone_[static_cast<size_t>(limb.joints[j])] = limb.joints[bone];
      }
    }
  }

  std::vector<RigSetup::Follower> find() {
    std::vector<RigSetup::Follower> followers;
    for (const int i : plan_.model.parentsFirst) {
      int& bone = bone_[static_cast<size_t>(i)];
      if (bone != -1) continue;
      const int parent = plan_.model.nodes[static_cast<size_t>(i)].parent;
      if (parent != -1) bone = bone_[static_cast<size_t>(parent)];
      // What is below a leg's joint goes with it.
      if (bone != -1 && !following_.contains(parent)) continue;
      const int on = plan_.skin[static_cast<size_t>(i)].empty() ? -1 : boneUnder(i);
      if (on != -1 && on != bone) {
        bone = on;
        followers.push_back({plan_.model.reference(i), plan_.model.reference(on)});
      }
      if (bone != -1) following_.insert(i);
    }
    return followers;
  }

 private:
  int boneUnder(int node) const {
    const std::vector<std::string> words = wordsOf(plan_.model.nodes[static_cast<size_t>(node)].name);
    for (const Words kind : {armWords, fingerWords, heldWords, looseWords}) {
      if (hasWord(words, kind)) return -1;
    }
    const glm::dvec3 at = plan_.at(node);
    const bool helper = hasWord(words, helperWords);
    int best = -1;
    double least = HUGE_VAL;
    for (const Limb& limb : plan_.limbs) {
      if (plan_.model.isAncestor(node, limb.chain.front())) return -1;
      if (sideOf(words) * sideOf(wordsOf(plan_.model, limb.chain)) < 0) continue;
      if (!helper && glm::length(at - plan_.at(limb.root())) < hipShare * limb.reach) continue;
      const std::vector<glm::dvec3> points = plan_.pointsOf(limb);
      for (size_t k = 0; k + 1 < points.size(); ++k) {
        // On a joint, the bone that begins there counts.
        const double distance = distanceTo(points[k], points[k + 1], at);
        if (distance > onBoneShare * limb.reach || distance > least + 1e-6 * limb.reach) continue;
        least = distance;
        best = limb.joints[limb.inBody + k];
      }
    }
    return best;
  }

  const BodyPlan& plan_;
  std::vector<int> bone_;  // the joint at whose bone a node goes, -1: the body
  std::set<int> following_;
};

}  // namespace

std::vector<RigSetup::Follower> findFollowers(const BodyPlan& plan) { return FollowerFinder(plan).find(); }

}  // namespace skitter

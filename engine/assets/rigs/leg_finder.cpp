#include "assets/rigs/leg_finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assets/rigs/joint_names.h"

namespace skitter {
namespace {

constexpr double offsetShare = 0.1;  // of the last bone: skin so far beyond its end is a foot without a joint
constexpr double shortest = 0.5;     // of the longest limb's reach: a shorter one is a palp, a claw or a toe
constexpr double levelShare = 0.25;  // of the reach: feet are no further from the middle one's height
constexpr size_t mostJoints = 2048, mostLeaves = 128;  // of all; of those near the ground
constexpr size_t leastBones = 2;                       // one bone cannot choose where its foot goes
constexpr double sharedShare = 0.05;  // of the reach: nearer first joints are one point of the body
constexpr double flatShare = 0.03;  // of its length: skin of a joint that is no higher is a plate or a shadow
constexpr double outsideShare = 0.1;  // of the reach: a foot outside the chain is no further from its end

class LimbFinder {
 public:
  LimbFinder(const Model& model, const SkinOfNodes& skin, const glm::dvec3& up, double lowShare)
      : model_(model),
        own_(skin),
        up_(up),
        lowShare_(lowShare),
        inTree_(model.nodes.size(), false),
        children_(model.nodes.size()) {}

  LimbSearch find() {
    growTree();
    if (std::count(inTree_.begin(), inTree_.end(), true) > static_cast<std::ptrdiff_t>(mostJoints)) return {};
    measure();
    std::vector<Limb> limbs = groundLeaves();
    // Nothing that walks is so branched, and the search below takes its time by the cube.
    if (limbs.size() > mostLeaves) return {};
    limbs = mergeToes(std::move(limbs));
    const std::vector<size_t> count = countLeaves(limbs);
    for (Limb& limb : limbs) climb(limb, count);
    addFeet(limbs);
    limbs = withSkin(limbs);
    // What is no leg must not tell where legs begin, and where they begin says how long they are.
    noteSingleBones(limbs);
    limbs = choose(limbs);
    skipShared(limbs);
    result_.limbs = choose(limbs);
    return std::move(result_);
  }

 private:
  const Model::Node& node(int i) const { return model_.nodes[static_cast<size_t>(i)]; }
  const std::vector<size_t>& skinOf(int i) const { return own_[static_cast<size_t>(i)]; }
  double height(const glm::dvec3& p) const { return glm::dot(p, up_); }

  // The extent of what may be legs, arms, heads: skin of joints that do not branch. What belongs to no joint
  // or to the whole body may lie below the feet, as may a plate with a joint of its own.
  void measure() {
    std::vector<size_t> ends(model_.nodes.size(), 0);
    for (size_t i = 0; i < model_.nodes.size(); ++i) {
      if (!inTree_[i] || !children_[i].empty()) continue;
      for (int k = static_cast<int>(i); k != -1 && inTree_[static_cast<size_t>(k)]; k = node(k).parent)
        ++ends[static_cast<size_t>(k)];
    }
    bool any = false;
    for (size_t i = 0; i < model_.nodes.size(); ++i) {
      if (!inTree_[i] || ends[i] > 1 || own_[i].empty()) continue;
      glm::dvec3 least(HUGE_VAL), most(-HUGE_VAL);
      for (const size_t v : own_[i]) {
        least = glm::min(least, model_.vertices[v].position);
        most = glm::max(most, model_.vertices[v].position);
      }
      const glm::dvec3 size = most - least;
      if (std::fabs(height(size)) < flatShare * glm::length(size)) continue;
      const double a = height(least), b = height(most);
      lowest_ = any ? std::min({lowest_, a, b}) : std::min(a, b);
      highest_ = any ? std::max({highest_, a, b}) : std::max(a, b);
      any = true;
    }
  }

  // Joints and what hangs from them (end markers carry no skin and are in no skin), helpers left out.
  void growTree() {
    for (int i : model_.parentsFirst) {
      const auto index = static_cast<size_t>(i);
      const int parent = node(i).parent;
      const bool below = parent != -1 && inTree_[static_cast<size_t>(parent)];
      const bool helper = own_[index].empty() && hasWord(wordsOf(node(i).name), helperWords);
      inTree_[index] = (node(i).joint || below) && !helper;
      if (inTree_[index] && below) children_[static_cast<size_t>(parent)].push_back(i);
    }
  }

  bool hasSkin(int top) const {
    if (!skinOf(top).empty()) return true;
    const std::vector<int>& below = children_[static_cast<size_t>(top)];
    return std::any_of(below.begin(), below.end(), [&](int child) { return hasSkin(child); });
  }

  // Feet whose skin hangs from a joint outside the chain that rests where the chain ends.
  void addFeet(std::vector<Limb>& limbs) const {
    // A foot is not the longest limb, so that limb chooses first.
    std::stable_sort(limbs.begin(), limbs.end(),
                     [](const Limb& a, const Limb& b) { return a.reach > b.reach; });
    std::vector<int> feet;
    const auto isFoot = [&](const Limb& limb) {
      return std::any_of(feet.begin(), feet.end(), [&](int foot) {
        return std::find(limb.chain.begin(), limb.chain.end(), foot) != limb.chain.end() ||
               model_.isAncestor(foot, limb.chain.front());
      });
    };
    std::vector<Limb> kept;
    for (Limb& limb : limbs) {
      if (isFoot(limb)) continue;
      const int foot = limb.boneCount() > 0 ? footOf(limb, feet) : -1;
      if (foot != -1) {
        feet.push_back(foot);
        endAt(limb, foot);
      }
      kept.push_back(std::move(limb));
    }
    limbs = std::move(kept);
  }

  void endAt(Limb& limb, int foot) const {
    // The chain's own end is a marker without skin, or a part of the foot in the same place.
    const double apart = glm::length(node(foot).position() - node(limb.joints.back()).position());
    const bool marker = skinOf(limb.joints.back()).empty() || apart < 0.3 * outsideShare * limb.reach;
    if (limb.joints.size() > 1 && marker) limb.joints.pop_back();
    findTip(limb, foot, node(limb.joints.back()).position());
    limb.joints.push_back(foot);
    limb.chain.push_back(foot);
    limb.measure(model_);
  }

  int footOf(const Limb& limb, const std::vector<int>& taken) const {
    const int root = limb.joints.front(), side = sideOf(wordsOf(model_, limb.chain));
    const glm::dvec3 last = node(limb.joints.back()).position();
    const auto distance = [&](int i) {
      const glm::dvec3 at = node(i).position();
      return std::min(glm::length(at - last), glm::length(at - limb.tip));
    };
    const auto suits = [&](int i) {
      const bool outside = i != root && !model_.isAncestor(i, root) && !model_.isAncestor(root, i);
      if (!inTree_[static_cast<size_t>(i)] || !outside) return false;
      if (std::find(taken.begin(), taken.end(), i) != taken.end()) return false;
      if (side * sideOf(wordsOf(node(i).name)) < 0) return false;
      return distance(i) <= outsideShare * limb.reach && hasSkin(i);
    };
    int best = -1;
    for (const int i : model_.parentsFirst) {
      // Of a foot's own joints the first that stands there counts.
      if (!suits(i) || (best != -1 && model_.isAncestor(best, i))) continue;
      if (best == -1 || distance(i) < distance(best) - 1e-9) best = i;
    }
    // Skin of the chain's own end reaches on: nothing has to be added.
    const std::vector<size_t>& own = skinOf(limb.joints.back());
    return best != -1 && own.size() > skinBelow(best) ? -1 : best;
  }

  size_t skinBelow(int top) const {
    size_t count = skinOf(top).size();
    for (const int child : children_[static_cast<size_t>(top)]) count += skinBelow(child);
    return count;
  }

  // A chain that carries no skin steers something else, or is left of a body whose mesh is not here.
  std::vector<Limb> withSkin(const std::vector<Limb>& limbs) {
    std::vector<Limb> kept;
    size_t bare = 0;
    for (const Limb& limb : limbs) {
      const bool skin = std::any_of(limb.joints.begin(), limb.joints.end(),
                                    [&](int joint) { return !skinOf(joint).empty(); });
      if (skin) kept.push_back(limb);
      bare += !skin && limb.boneCount() >= leastBones;
    }
    if (bare > 0)
      result_.notes.push_back(
          fmt::format("{} chains that end near the ground carry no skin: they are no legs", bare));
    return kept;
  }

  void noteSingleBones(const std::vector<Limb>& limbs) {
    double longest = 0;
    for (const Limb& limb : limbs) longest = std::max(longest, limb.reach);
    std::vector<std::string> names;
    for (const Limb& limb : limbs) {
      if (limb.boneCount() == 1 && limb.reach > shortest * longest)
        names.push_back(model_.reference(limb.joints.front()));
    }
    if (names.size() < 2) return;
    result_.notes.push_back(
        fmt::format("{} chains that end near the ground have one bone ({}): a leg needs two bones, so that "
                    "its foot can come nearer to the body",
                    names.size(), fmt::join(names, ", ")));
  }

  std::vector<Limb> groundLeaves() const {
    std::vector<Limb> leaves;
    const double low = lowest_ + lowShare_ * (highest_ - lowest_);
    for (size_t i = 0; i < model_.nodes.size(); ++i) {
      if (!inTree_[i] || !children_[i].empty()) continue;
      Limb limb;
      limb.joints = {static_cast<int>(i)};
      findTip(limb);
      if (height(limb.tip) <= low) leaves.push_back(std::move(limb));
    }
    return leaves;
  }

  // Where the skin of the last joint ends, seen along the last bone and downward.
  void findTip(Limb& limb) const {
    const glm::dvec3 end = node(limb.joints.back()).position();
    int parent = node(limb.joints.back()).parent;
    while (parent != -1 && inTree_[static_cast<size_t>(parent)] &&
           !(glm::length(end - node(parent).position()) > 1e-9))
      parent = node(parent).parent;
    const bool bone = parent != -1 && inTree_[static_cast<size_t>(parent)];
    findTip(limb, limb.joints.back(), bone ? node(parent).position() : end);
  }

  void findTip(Limb& limb, int last, const glm::dvec3& boneStart) const {
    const glm::dvec3 end = node(last).position();
    limb.tip = end;
    limb.footJoint = true;
    const double bone = glm::length(end - boneStart);
    glm::dvec3 axis = -up_;
    if (bone > 1e-9) {
      const glm::dvec3 sum = (end - boneStart) / bone - up_;
      if (glm::length(sum) > 0.1) axis = glm::normalize(sum);
    }
    double farthest = 0;
    for (size_t v : skinOf(last)) {
      farthest = std::max(farthest, glm::dot(model_.vertices[v].position - end, axis));
    }
    if (!(farthest > offsetShare * bone) || !(farthest > 0)) return;
    glm::dvec3 sum(0);
    size_t count = 0;
    for (size_t v : skinOf(last)) {
      const glm::dvec3& p = model_.vertices[v].position;
      if (glm::dot(p - end, axis) < 0.97 * farthest) continue;
      sum += p;
      ++count;
    }
    limb.tip = sum / static_cast<double>(count);
    limb.footJoint = false;
  }

  std::vector<size_t> countLeaves(const std::vector<Limb>& leaves) const {
    std::vector<size_t> count(model_.nodes.size(), 0);
    for (const Limb& leaf : leaves) {
      for (int i = leaf.joints.back(); i != -1 && inTree_[static_cast<size_t>(i)]; i = node(i).parent)
        ++count[static_cast<size_t>(i)];
    }
    return count;
  }

  // Where leaves part near the ground, under a limb longer than they are, the longest leaf stands for the
  // foot.
  std::vector<Limb> mergeToes(std::vector<Limb> leaves) const {
    for (bool merged = true; merged;) {
      merged = false;
      const std::vector<size_t> count = countLeaves(leaves);
      for (size_t a = 0; a < leaves.size() && !merged; ++a) {
        const int fork = forkOf(leaves[a].joints.back(), count);
        if (fork == -1 || !isFoot(fork, leaves[a].tip, count)) continue;
        const glm::dvec3 at = node(fork).position();
        size_t longest = a;
        for (size_t b = 0; b < leaves.size(); ++b) {
          if (!model_.isAncestor(fork, leaves[b].joints.back())) continue;
          if (glm::length(leaves[b].tip - at) > glm::length(leaves[longest].tip - at)) longest = b;
        }
        std::vector<Limb> kept;
        for (size_t b = 0; b < leaves.size(); ++b) {
          if (b == longest || !model_.isAncestor(fork, leaves[b].joints.back())) kept.push_back(leaves[b]);
        }
        merged = kept.size() < leaves.size();
        leaves = std::move(kept);
      }
    }
    return leaves;
  }

  int forkOf(int leaf, const std::vector<size_t>& count) const {
    int i = leaf;
    while (i != -1 && inTree_[static_cast<size_t>(i)] && count[static_cast<size_t>(i)] < 2)
      i = node(i).parent;
    return i != -1 && inTree_[static_cast<size_t>(i)] ? i : -1;
  }

  bool isFoot(int fork, const glm::dvec3& tip, const std::vector<size_t>& count) const {
    if (height(node(fork).position()) > lowest_ + footShare * (highest_ - lowest_)) return false;
    double above = 0;
    for (int i = fork; node(i).parent != -1 && inTree_[static_cast<size_t>(node(i).parent)];
         i = node(i).parent) {
      const int parent = node(i).parent;
      if (count[static_cast<size_t>(parent)] > count[static_cast<size_t>(fork)]) break;
      above += glm::length(node(i).position() - node(parent).position());
    }
    return above > glm::length(tip - node(fork).position());
  }

  // From the leaf up to where other limbs join.
  void climb(Limb& limb, const std::vector<size_t>& count) const {
    int parent = node(limb.joints.front()).parent;
    while (parent != -1 && inTree_[static_cast<size_t>(parent)] && count[static_cast<size_t>(parent)] == 1) {
      limb.joints.insert(limb.joints.begin(), parent);
      parent = node(parent).parent;
    }
    limb.chain = limb.joints;
    skipShortBones(limb);
    limb.measure(model_);
  }

  // A joint that lies in the place of the one after it has no bone.
  void skipShortBones(Limb& limb) const {
    const double least = 1e-4 * std::max(highest_ - lowest_, 1e-9);
    std::vector<int> kept;
    for (size_t i = 0; i < limb.joints.size(); ++i) {
      const bool last = i + 1 == limb.joints.size();
      const glm::dvec3 end = last ? limb.tip : node(limb.joints[i + 1]).position();
      if ((last && limb.footJoint) || glm::length(end - node(limb.joints[i]).position()) > least) {
        kept.push_back(limb.joints[i]);
      }
    }
    limb.joints = std::move(kept);
  }

  // Several limbs that begin in one point begin in the body: their first bones are spokes, not legs.
  void skipShared(std::vector<Limb>& limbs) const {
    for (bool shared = true; shared;) {
      std::vector<bool> skip(limbs.size(), false);
      for (size_t a = 0; a < limbs.size(); ++a) {
        for (size_t b = 0; b < limbs.size(); ++b) {
          if (a == b || limbs[a].boneCount() < 2 || limbs[b].boneCount() < 2) continue;
          const double apart =
              glm::length(node(limbs[a].root()).position() - node(limbs[b].root()).position());
          if (apart < sharedShare * std::min(limbs[a].reach, limbs[b].reach)) skip[a] = true;
        }
      }
      shared = false;
      for (size_t i = 0; i < limbs.size(); ++i) {
        if (!skip[i]) continue;
        ++limbs[i].inBody;
        limbs[i].measure(model_);
        shared = true;
      }
    }
  }

  // Long enough for legs, and about level: a tail or a jaw that happens to lie low is neither.
  std::vector<Limb> choose(const std::vector<Limb>& limbs) const {
    double longest = 0;
    for (const Limb& limb : limbs)
      longest = std::max(longest, limb.boneCount() >= leastBones ? limb.reach : 0.0);
    std::vector<double> heights;
    std::vector<Limb> chosen;
    for (const Limb& limb : limbs) {
      if (limb.boneCount() < leastBones || limb.reach < shortest * longest) continue;
      chosen.push_back(limb);
      heights.push_back(height(limb.tip));
    }
    if (chosen.empty()) return chosen;
    std::nth_element(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2),
                     heights.end());
    const double middle = heights[heights.size() / 2];
    const auto aloft = [&](const Limb& limb) {
      return std::fabs(height(limb.tip) - middle) > levelShare * limb.reach;
    };
    chosen.erase(std::remove_if(chosen.begin(), chosen.end(), aloft), chosen.end());
    return chosen;
  }

  const Model& model_;
  const SkinOfNodes& own_;
  const glm::dvec3 up_;
  const double lowShare_;
  LimbSearch result_;
  std::vector<bool> inTree_;
  std::vector<std::vector<int>> children_;
  double lowest_ = 0, highest_ = 0;
};

}  // namespace

size_t Limb::boneCount() const {
  const size_t points = joints.size() - inBody + (footJoint ? 0 : 1);
  return points > 0 ? points - 1 : 0;
}

void Limb::endAtJoint(const Model& model) {
  tip = model.nodes[static_cast<size_t>(joints.back())].position();
  footJoint = true;
  measure(model);
}

void Limb::measure(const Model& model) {
  const auto at = [&](size_t i) { return model.nodes[static_cast<size_t>(joints[i])].position(); };
  reach = 0;
  for (size_t i = inBody; i + 1 < joints.size(); ++i) reach += glm::length(at(i + 1) - at(i));
  if (!joints.empty()) reach += glm::length(tip - at(joints.size() - 1));
}

SkinOfNodes skinOfNodes(const Model& model) {
  SkinOfNodes skin(model.nodes.size());
  for (size_t v = 0; v < model.vertices.size(); ++v) {
    const Model::Vertex& vertex = model.vertices[v];
    const Model::Influence* heaviest = &model.influences[vertex.firstInfluence];
    for (uint32_t k = 1; k < vertex.influences; ++k) {
      const Model::Influence& influence = model.influences[vertex.firstInfluence + k];
      if (influence.weight > heaviest->weight) heaviest = &influence;
    }
    skin[heaviest->node].push_back(v);
  }
  return skin;
}

LimbSearch findLimbs(const Model& model, const SkinOfNodes& skin, const glm::dvec3& up, double lowShare) {
  return LimbFinder(model, skin, up, lowShare).find();
}

}  // namespace skitter

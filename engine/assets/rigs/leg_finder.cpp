#include "assets/rigs/leg_finder.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace skitter {
namespace {

constexpr double lowShare = 0.2;     // of the model's height: a foot's tip lies in it
constexpr double offsetShare = 0.1;  // of the last bone: skin so far beyond its end is a foot without a joint
constexpr double shortest = 0.5;     // of the longest limb's reach: a shorter one is a palp, a claw or a toe
constexpr double levelShare = 0.25;  // of the reach: feet are no further from the middle one's height
constexpr size_t mostJoints = 2048, mostLeaves = 128;  // of all; of those near the ground
constexpr size_t leastBones = 2;                       // one bone cannot choose where its foot goes
constexpr double sharedShare = 0.05;  // of the reach: nearer first joints are one point of the body

// Joints that steer others and carry no skin.
constexpr std::array helperWords = {"ik", "pole", "target", "ctrl", "control", "helper", "twist", "mch"};

class LimbFinder {
 public:
  LimbFinder(const Model& model, const glm::dvec3& up)
      : model_(model),
        up_(up),
        own_(model.nodes.size()),
        inTree_(model.nodes.size(), false),
        children_(model.nodes.size()) {}

  std::vector<Limb> find() {
    measure();
    growTree();
    if (std::count(inTree_.begin(), inTree_.end(), true) > static_cast<std::ptrdiff_t>(mostJoints)) return {};
    std::vector<Limb> limbs = groundLeaves();
    // Nothing that walks is so branched, and the search below takes its time by the cube.
    if (limbs.size() > mostLeaves) return {};
    limbs = mergeToes(std::move(limbs));
    const std::vector<size_t> count = countLeaves(limbs);
    for (Limb& limb : limbs) climb(limb, count);
    // What is no leg must not tell where legs begin, and where they begin says how long they are.
    limbs = choose(limbs);
    skipShared(limbs);
    return choose(limbs);
  }

 private:
  const Model::Node& node(int i) const { return model_.nodes[static_cast<size_t>(i)]; }
  double height(const glm::dvec3& p) const { return glm::dot(p, up_); }

  // The extent of the mesh, and each vertex with the node that it follows most.
  void measure() {
    for (size_t v = 0; v < model_.vertices.size(); ++v) {
      const Model::Vertex& vertex = model_.vertices[v];
      const Model::Influence* heaviest = &model_.influences[vertex.firstInfluence];
      for (uint32_t k = 1; k < vertex.influences; ++k) {
        const Model::Influence& influence = model_.influences[vertex.firstInfluence + k];
        if (influence.weight > heaviest->weight) heaviest = &influence;
      }
      own_[heaviest->node].push_back(v);
      const double h = height(vertex.position);
      lowest_ = v == 0 ? h : std::min(lowest_, h);
      highest_ = v == 0 ? h : std::max(highest_, h);
    }
  }

  // Joints and what hangs from them (end markers carry no skin and are in no skin), helpers left out.
  void growTree() {
    for (int i : model_.parentsFirst) {
      const auto index = static_cast<size_t>(i);
      const int parent = node(i).parent;
      const bool below = parent != -1 && inTree_[static_cast<size_t>(parent)];
      const std::vector<std::string> words = wordsOf(node(i).name);
      const bool helper =
          own_[index].empty() && std::any_of(words.begin(), words.end(), [](const std::string& word) {
            return std::find(helperWords.begin(), helperWords.end(), word) != helperWords.end();
          });
      inTree_[index] = (node(i).joint || below) && !helper;
      if (inTree_[index] && below) children_[static_cast<size_t>(parent)].push_back(i);
    }
  }

  std::vector<Limb> groundLeaves() const {
    std::vector<Limb> leaves;
    const double low = lowest_ + lowShare * (highest_ - lowest_);
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
    const int last = limb.joints.back();
    const glm::dvec3 end = node(last).position();
    limb.tip = end;
    int parent = node(last).parent;
    double bone = 0;
    while (parent != -1 && inTree_[static_cast<size_t>(parent)] && !(bone > 1e-9)) {
      bone = glm::length(end - node(parent).position());
      if (bone > 1e-9) break;
      parent = node(parent).parent;
    }
    glm::dvec3 axis = -up_;
    if (bone > 1e-9) {
      const glm::dvec3 sum = (end - node(parent).position()) / bone - up_;
      if (glm::length(sum) > 0.1) axis = glm::normalize(sum);
    }
    double farthest = 0;
    for (size_t v : own_[static_cast<size_t>(last)]) {
      farthest = std::max(farthest, glm::dot(model_.vertices[v].position - end, axis));
    }
    if (!(farthest > offsetShare * bone) || !(farthest > 0)) return;
    glm::dvec3 sum(0);
    size_t count = 0;
    for (size_t v : own_[static_cast<size_t>(last)]) {
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
    if (height(node(fork).position()) > lowest_ + lowShare * (highest_ - lowest_)) return false;
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
  const glm::dvec3 up_;
  std::vector<std::vector<size_t>> own_;  // vertices that follow a node most
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

std::vector<Limb> findLimbs(const Model& model, const glm::dvec3& up) { return LimbFinder(model, up).find(); }

std::vector<std::string> wordsOf(const std::string& name) {
  const auto is = [](int (*kind)(int), char c) { return kind(static_cast<unsigned char>(c)) != 0; };
  std::vector<std::string> words;
  for (size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    if (!is(std::isalnum, c)) continue;
    const char before = i > 0 ? name[i - 1] : ' ';
    // A word begins after anything else, where a capital follows a small letter, and where letters and digits
    // meet; of capitals in a row the last begins the next word if a small letter follows.
    const bool begins = !is(std::isalnum, before) || (is(std::isupper, c) && is(std::islower, before)) ||
                        is(std::isdigit, c) != is(std::isdigit, before) ||
                        (is(std::isupper, c) && is(std::isupper, before) && i + 1 < name.size() &&
                         is(std::islower, name[i + 1]));
    if (begins) words.emplace_back();
    words.back().push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  }
  return words;
}

}  // namespace skitter

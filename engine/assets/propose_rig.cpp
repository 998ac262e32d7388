#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>

#include "leg_finder.h"
#include "rig_setup.h"
#include "skitter/error.h"

namespace skitter {
namespace {

constexpr double standShare = 0.75;     // of the reach, root to home: no leg stands straighter
constexpr double straightShare = 0.93;  // of the reach, root to tip: a rest pose beyond it shows no knee
constexpr double bendDegrees = 40;      // given to legs that rest straight
constexpr double leastCone = 45, mostCone = 120, rootCone = 60, rootMargin = 40;  // degrees
constexpr double foldShare = 0.35;  // of the reach, root to foot: a leg folds as far
constexpr double degrees = 180 / 3.14159265358979323846;
constexpr size_t mostSamples = 400;  // of the mesh, when it is tried for symmetry

constexpr std::array frontWords = {"front", "head",   "neck",    "jaw",      "eye",  "nose",
                                   "snout", "face",   "skull",   "mouth",    "fang", "tooth",
                                   "teeth", "pincer", "antenna", "chelicera"};
constexpr std::array backWords = {"back", "rear", "hind", "tail", "abdomen", "spinneret", "stinger"};

template <size_t Size>
bool hasWord(const std::vector<std::string>& words, const std::array<const char*, Size>& wanted) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return std::find(wanted.begin(), wanted.end(), word) != wanted.end();
  });
}

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  const double lengths = glm::length(a) * glm::length(b);
  return lengths > 0 ? std::acos(std::clamp(glm::dot(a, b) / lengths, -1.0, 1.0)) * degrees : 0;
}

std::string describe(const glm::dvec3& v) {
  for (int k = 0; k < 3; ++k) {
    if (std::fabs(v[k]) > 1 - 1e-9) return fmt::format("{}{}", v[k] > 0 ? '+' : '-', "XYZ"[k]);
  }
  return fmt::format("({:.3f}, {:.3f}, {:.3f})", v.x, v.y, v.z);
}

class Proposer {
 public:
  explicit Proposer(const Model& model) : model_(model) {}

  RigProposal propose() {
    RigSetup& setup = result_.setup;
    setup.model = std::filesystem::path(model_.name).filename().string();
    chooseUp();
    setup.up = up_;
    if (limbs_.empty()) {
      note("no chain of joints ends near the ground: there is nothing to walk on");
      return result_;
    }
    chooseForward();
    setup.forward = forward_;
    pairLimbs();
    nameLimbs();
    if (!canWalk()) return result_;
    setup.legLength = 1;
    describeLegs();
    chooseColour();
    return result_;
  }

 private:
  const glm::dvec3 at(int node) const { return model_.nodes[static_cast<size_t>(node)].position(); }
  double height(const glm::dvec3& p) const { return glm::dot(p, up_); }
  glm::dvec3 flat(const glm::dvec3& p) const { return p - up_ * height(p); }
  void note(std::string text) { result_.notes.push_back(std::move(text)); }
  std::vector<glm::dvec3> pointsOf(const Limb& limb) const {
    std::vector<glm::dvec3> points;
    for (size_t j = limb.inBody; j < limb.joints.size(); ++j) points.push_back(at(limb.joints[j]));
    if (!limb.footJoint) points.push_back(limb.tip);
    return points;
  }

  // glTF is +Y up; another axis only where that leaves fewer than two legs.
  void chooseUp() {
    const glm::dvec3 axes[] = {{0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, -1, 0}};
    for (const glm::dvec3& axis : axes) {
      const std::vector<Limb> limbs = findLimbs(model_, axis);
      if (limbs.size() <= limbs_.size() || (limbs.size() < 2 && axis.y < 1)) continue;
      up_ = axis;
      limbs_ = limbs;
      if (limbs.size() >= 2) break;
    }
    if (up_.y < 1) note(fmt::format("up is {}: along +Y no legs stand", describe(up_)));
  }

  // How far the model is from its own mirror image across `side`: shares of the reach, 0 is symmetric.
  double asymmetry(const glm::dvec3& side) const {
    glm::dvec3 centre(0);
    double reach = 0;
    for (const Limb& limb : limbs_) {
      centre += limb.tip / static_cast<double>(limbs_.size());
      reach = std::max(reach, limb.reach);
    }
    std::vector<glm::dvec3> points;
    for (const Limb& limb : limbs_) {
      points.push_back(limb.tip);
      points.push_back(at(limb.root()));
    }
    double sum = averageMiss(points, points, centre, side);
    std::vector<glm::dvec3> mesh;
    const size_t stride = model_.vertices.size() / (4 * mostSamples) + 1;
    for (size_t v = 0; v < model_.vertices.size(); v += stride) mesh.push_back(model_.vertices[v].position);
    std::vector<glm::dvec3> samples;
    for (size_t v = 0; v < mesh.size(); v += mesh.size() / mostSamples + 1) samples.push_back(mesh[v]);
    if (!mesh.empty()) sum += averageMiss(samples, mesh, centre, side);
    return sum / std::max(reach, 1e-9);
  }

  static double averageMiss(const std::vector<glm::dvec3>& from, const std::vector<glm::dvec3>& to,
                            const glm::dvec3& centre, const glm::dvec3& side) {
    double sum = 0;
    for (const glm::dvec3& p : from) {
      const glm::dvec3 image = p - side * (2 * glm::dot(p - centre, side));
      double nearest = HUGE_VAL;
      for (const glm::dvec3& q : to) {
        const glm::dvec3 d = image - q;
        nearest = std::min(nearest, glm::dot(d, d));
      }
      sum += std::sqrt(nearest);
    }
    return sum / static_cast<double>(from.size());
  }

  // The axis across the body: from names of left and right, else the best plane of symmetry.
  glm::dvec3 findSide(glm::dvec3& namedLeft) const {
    glm::dvec3 left(0), right(0);
    size_t lefts = 0, rights = 0;
    for (const Limb& limb : limbs_) {
      std::vector<std::string> words;
      for (int joint : limb.joints) {
        for (std::string& word : wordsOf(model_.nodes[static_cast<size_t>(joint)].name))
          words.push_back(std::move(word));
      }
      const bool isLeft = hasWord(words, std::array{"l", "left"}),
                 isRight = hasWord(words, std::array{"r", "right"});
      if (isLeft == isRight) continue;
      (isLeft ? left : right) += flat(limb.tip);
      ++(isLeft ? lefts : rights);
    }
    const glm::dvec3 front = std::fabs(up_.z) < 0.5 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, -up_.z, 0);
    const glm::dvec3 across = glm::cross(up_, front);
    if (lefts == rights && 2 * lefts >= limbs_.size() && glm::length(left - right) > 1e-9) {
      namedLeft = glm::normalize(left - right);
      for (const glm::dvec3& axis : {across, front}) {
        if (std::fabs(glm::dot(axis, namedLeft)) > 0.99)
          namedLeft = axis * (glm::dot(axis, namedLeft) > 0 ? 1.0 : -1.0);
      }
      return namedLeft;
    }
    glm::dvec3 best = across;
    double least = asymmetry(across);
    // The file's own axes first: another plane must be clearly better.
    if (const double value = asymmetry(front); value < 0.8 * least - 0.002) {
      least = value;
      best = front;
    }
    if (least < 0.05) return best;
    for (int k = 1; k < 36; ++k) {
      const double angle = k * 5 / degrees;
      const glm::dvec3 side = across * std::cos(angle) + front * std::sin(angle);
      if (const double value = asymmetry(side); value < 0.6 * least) {
        least = value;
        best = side;
      }
    }
    return best;
  }

  // Which way along the body is forward, by the first evidence there is.
  void chooseForward() {
    glm::dvec3 namedLeft(0);
    const glm::dvec3 side = findSide(namedLeft);
    forward_ = glm::cross(side, up_);
    double extent = 0;
    glm::dvec3 sums[3] = {};  // front, back, all
    double counts[3] = {};
    for (size_t i = 0; i < model_.nodes.size(); ++i) {
      if (!model_.nodes[i].joint) continue;
      const std::vector<std::string> words = wordsOf(model_.nodes[i].name);
      const glm::dvec3 p = model_.nodes[i].position();
      for (const size_t kind : {size_t{0}, size_t{1}, size_t{2}}) {
        if (kind == 0 && !hasWord(words, frontWords)) continue;
        if (kind == 1 && !hasWord(words, backWords)) continue;
        sums[kind] += p;
        ++counts[kind];
      }
    }
    for (const Limb& limb : limbs_) extent = std::max(extent, limb.reach);
    for (size_t kind = 0; kind < 3; ++kind) sums[kind] /= std::max(counts[kind], 1.0);
    const glm::dvec3 named = (counts[0] > 0 ? sums[0] : sums[2]) - (counts[1] > 0 ? sums[1] : sums[2]);
    const double along = glm::dot(named, forward_);
    const bool leftSays = glm::length(namedLeft) > 0;
    std::string evidence;
    if (std::fabs(along) > 0.02 * extent) {
      if (along < 0) forward_ = -forward_;
      evidence = "joint names of head or tail, front or back";
      if (leftSays && glm::dot(glm::cross(namedLeft, up_), forward_) < 0) {
        note("joints named left are on the creature's right: legs are named by where they are");
      }
    } else if (leftSays) {
      evidence = "joint names of left and right";
    } else {
      if (forward_.z < -1e-6 || (std::fabs(forward_.z) <= 1e-6 && forward_.x < 0)) forward_ = -forward_;
      evidence = "symmetry alone, so it may be the other way round";
    }
    note(fmt::format("forward is {}: by {}", describe(forward_), evidence));
    left_ = glm::cross(up_, forward_);
  }

  // Legs come in mirrored pairs where any do; what has no partner is a tail or an arm.
  void pairLimbs() {
    middle_ = 0;
    for (const Limb& limb : limbs_) middle_ += glm::dot(limb.tip, left_) / static_cast<double>(limbs_.size());
    std::vector<bool> paired(limbs_.size(), false);
    for (size_t a = 0; a < limbs_.size(); ++a) {
      if (paired[a]) continue;
      const glm::dvec3 image = limbs_[a].tip - left_ * (2 * (glm::dot(limbs_[a].tip, left_) - middle_));
      size_t best = a;
      double nearest = 0.25 * limbs_[a].reach;
      for (size_t b = a + 1; b < limbs_.size(); ++b) {
        if (paired[b] ||
            (glm::dot(limbs_[b].tip, left_) > middle_) == (glm::dot(limbs_[a].tip, left_) > middle_)) {
          continue;
        }
        const double apart = glm::length(limbs_[b].tip - image);
        if (apart > nearest) continue;
        nearest = apart;
        best = b;
      }
      if (best == a) continue;
      paired[a] = paired[best] = true;
      // Mirrored feet end alike.
      if (limbs_[a].footJoint == limbs_[best].footJoint) continue;
      for (const size_t i : {a, best}) {
        if (!limbs_[i].footJoint && limbs_[i].boneCount() > 2) limbs_[i].endAtJoint(model_);
      }
    }
    if (std::find(paired.begin(), paired.end(), true) == paired.end()) return;
    std::vector<Limb> kept;
    for (size_t i = 0; i < limbs_.size(); ++i) {
      if (paired[i]) {
        kept.push_back(limbs_[i]);
      } else {
        note(fmt::format("the chain from {} has no mirror image: left out",
                         model_.reference(limbs_[i].root())));
      }
    }
    limbs_ = std::move(kept);
  }

  // Front to back: L1, R1, L2, R2, ...
  void nameLimbs() {
    std::stable_sort(limbs_.begin(), limbs_.end(), [&](const Limb& a, const Limb& b) {
      return glm::dot(a.tip, forward_) > glm::dot(b.tip, forward_);
    });
    std::vector<Limb> sides[2];
    for (Limb& limb : limbs_) sides[glm::dot(limb.tip, left_) > middle_ ? 0 : 1].push_back(std::move(limb));
    limbs_.clear();
    for (size_t row = 0; row < std::max(sides[0].size(), sides[1].size()); ++row) {
      for (size_t side = 0; side < 2; ++side) {
        if (row >= sides[side].size()) continue;
        Limb& limb = sides[side][row];
        FoundLeg found;
        found.name = fmt::format("{}{}", side == 0 ? 'L' : 'R', row + 1);
        found.joints = limb.chain;
        found.root = limb.root();
        found.footJoint = limb.footJoint;
        result_.found.push_back(found);
        // Along a side groups alternate, across they are opposite: trot, tripod, tetrapod.
        groupOf_.push_back((row + side) % 2 == 0 ? "A" : "B");
        limbs_.push_back(std::move(limb));
      }
    }
  }

  bool canWalk() {
    if (limbs_.size() < 2) note("one leg cannot walk");
    if (limbs_.size() > maxLegs) note(fmt::format("{} legs, expected at most {}", limbs_.size(), maxLegs));
    const auto tooLong = [](const Limb& limb) { return limb.boneCount() > maxBonesOfLeg; };
    const auto longLimb = std::find_if(limbs_.begin(), limbs_.end(), tooLong);
    if (longLimb != limbs_.end()) {
      note(fmt::format("the leg from {} has {} bones, expected at most {}",
                       model_.reference(longLimb->root()), longLimb->boneCount(), maxBonesOfLeg));
    }
    return limbs_.size() >= 2 && limbs_.size() <= maxLegs && longLimb == limbs_.end();
  }

  // Where the ground is, and where feet stand on it: no leg straighter than standShare of its reach.
  void placeFeet(std::vector<glm::dvec3>& homes) {
    double ground = 0, lowered = 0;
    for (const Limb& limb : limbs_) ground += height(limb.tip) / static_cast<double>(limbs_.size());
    const double rest = ground;
    for (const Limb& limb : limbs_) {
      const glm::dvec3 root = at(limb.root());
      glm::dvec3 out = flat(limb.tip) - flat(root);
      const double most = 0.9 * standShare * limb.reach;
      if (glm::length(out) > most) out *= most / glm::length(out);
      homes.push_back(flat(root) + out);
      const double stand = standShare * limb.reach;
      const double drop = std::sqrt(std::max(0.0, stand * stand - glm::dot(out, out)));
      ground = std::max(ground, height(root) - drop);
    }
    lowered = ground - rest;
    glm::dvec3 centre(0);
    for (glm::dvec3& home : homes) {
      home += up_ * ground;
      centre += home / static_cast<double>(homes.size());
    }
    result_.setup.origin = centre + left_ * (middle_ - glm::dot(centre, left_));
    if (lowered > 1e-6) {
      note(fmt::format(
          "the legs rest straight or wide: the ground is {:.3g} units above the feet at rest, so that "
          "they stand bent",
          lowered));
    }
  }

  // A leg that rests straight shows no knee: the way its joints leave the line from root to tip, however
  // little, else forward for legs below the body and upward for legs beside it.
  glm::dvec3 bendOf(const std::vector<glm::dvec3>& points, double reach) const {
    const glm::dvec3 chord = glm::normalize(points.back() - points.front());
    glm::dvec3 most(0);
    for (const glm::dvec3& p : points) {
      const glm::dvec3 off = (p - points.front()) - chord * glm::dot(p - points.front(), chord);
      if (glm::length(off) > glm::length(most)) most = off;
    }
    if (glm::length(most) > 0.005 * reach) return glm::normalize(most);
    return std::fabs(glm::dot(chord, up_)) > 0.7 ? forward_ : up_;
  }

  void describeLegs() {
    RigSetup& setup = result_.setup;
    std::vector<glm::dvec3> homes;
    placeFeet(homes);
    double height = 0, longest = 0;
    for (size_t i = 0; i < limbs_.size(); ++i) {
      const Limb& limb = limbs_[i];
      const std::vector<glm::dvec3> points = pointsOf(limb);
      RigSetup::Leg leg;
      leg.name = result_.found[i].name;
      leg.group = groupOf_[i];
      if (std::find(setup.groups.begin(), setup.groups.end(), leg.group) == setup.groups.end()) {
        setup.groups.push_back(leg.group);
      }
      for (size_t j = limb.inBody; j < limb.joints.size(); ++j) {
        leg.joints.push_back(model_.reference(limb.joints[j]));
      }
      if (!limb.footJoint) leg.tipOffset = limb.tip - at(limb.joints.back());
      leg.home = homes[i];
      const bool straight = glm::length(points.back() - points.front()) > straightShare * limb.reach;
      if (straight && points.size() > 2) {
        leg.bend = bendOf(points, limb.reach);
        leg.bendDegrees = bendDegrees;
      }
      setup.legs.push_back(std::move(leg));
      height +=
          (this->height(points.front()) - this->height(*setup.origin)) / static_cast<double>(limbs_.size());
      longest = std::max(longest, limb.reach);
    }
    std::sort(setup.groups.begin(), setup.groups.end());
    setup.bodyHeight = std::max(height, 0.1 * longest);
    setup.bodyRadius = bodyRadius(longest);
    describeChains();
    limitJoints();
  }

  void describeChains() {
    size_t inBody = 0, offsets = 0, bent = 0;
    for (size_t i = 0; i < limbs_.size(); ++i) {
      inBody += limbs_[i].inBody > 0;
      offsets += !limbs_[i].footJoint;
      bent += result_.setup.legs[i].bend.has_value();
    }
    if (inBody > 0) {
      note(fmt::format("the first joints of {} chains share one place: they stay with the body", inBody));
    }
    if (offsets > 0) note(fmt::format("{} feet have no joint: tipOffset is where their skin ends", offsets));
    if (bent > 0) note(fmt::format("{} legs rest straight: bend says which way their knees go", bent));
  }

  // Limits about the rest pose as it will be, bends included.
  void limitJoints() {
    RigSetup& setup = result_.setup;
    try {
      const Rig rig = buildRig(model_, setup, model_.name);
      for (size_t i = 0; i < setup.legs.size(); ++i)
        setup.legs[i].coneHalfAngleDegrees = conesOf(rig.legs[i]);
    } catch (const Error& error) {
      note(std::string(error.what()).substr(model_.name.size() + 2));
      setup.legs.clear();
    }
  }

  // Each joint may straighten what it bends at rest and fold as much again, and further where the leg could
  // not fold to foldShare of its reach; the first joint turns the leg.
  static std::vector<double> conesOf(const Leg& leg) {
    std::vector<double> cones;
    for (size_t i = 0; i < leg.bones.size(); ++i) {
      const glm::dvec3 bone(leg.bones[i].direction);
      const double cone =
          i == 0 ? std::max(rootCone, angleBetween(bone, glm::dvec3(leg.home - leg.root())) + rootMargin)
                 : std::max(leastCone, angleBetween(glm::dvec3(leg.bones[i - 1].direction), bone));
      cones.push_back(std::round(std::min(cone, mostCone)));
    }
    for (double widest = leastCone; widest < mostCone && foldedSpan(leg, cones) > foldShare; widest += 5) {
      for (size_t i = 1; i < cones.size(); ++i) cones[i] = std::max(cones[i], widest + 5);
    }
    return cones;
  }

  // The least distance from root to foot, a share of the reach, as every joint bends on the way it bends at
  // rest.
  static double foldedSpan(const Leg& leg, const std::vector<double>& cones) {
    constexpr int steps = 12;
    double least = 1;
    for (int step = 1; step <= steps; ++step) {
      glm::dquat turn(1, 0, 0, 0);
      glm::dvec3 tip(0);
      for (size_t i = 0; i < leg.bones.size(); ++i) {
        const glm::dvec3 bone(leg.bones[i].direction);
        if (i > 0) {
          const glm::dvec3 axis = glm::cross(glm::dvec3(leg.bones[i - 1].direction), bone);
          const double angle = cones[i] / degrees * step / steps;
          if (glm::length(axis) > 1e-6) turn = turn * glm::angleAxis(angle, glm::normalize(axis));
        }
        tip += turn * bone * double{leg.bones[i].length};
      }
      least = std::min(least, glm::length(tip) / double{leg.reach});
    }
    return least;
  }

  // Half the body's length: to the outermost root at least, to the end of what no leg moves at most.
  double bodyRadius(double longest) const {
    std::vector<bool> inLeg(model_.nodes.size(), false);
    const double origin = glm::dot(*result_.setup.origin, forward_);
    double roots = 0, body = 0;
    for (const Limb& limb : limbs_) {
      inLeg[static_cast<size_t>(limb.root())] = true;
      roots = std::max(roots, std::fabs(glm::dot(at(limb.root()), forward_) - origin));
    }
    for (int i : model_.parentsFirst) {
      const int parent = model_.nodes[static_cast<size_t>(i)].parent;
      if (parent != -1 && inLeg[static_cast<size_t>(parent)]) inLeg[static_cast<size_t>(i)] = true;
    }
    for (const Model::Vertex& vertex : model_.vertices) {
      if (inLeg[model_.influences[vertex.firstInfluence].node]) continue;
      body = std::max(body, std::fabs(glm::dot(vertex.position, forward_) - origin));
    }
    return std::max({roots, std::min(body, 0.5 * longest), 0.1 * longest});
  }

  // A model whose colours are in its pictures is white here, which no light suits.
  void chooseColour() {
    for (const Model::Vertex& vertex : model_.vertices) {
      if (glm::length(vertex.colour - glm::vec3(1)) > 0.1f) return;
    }
    if (model_.vertices.empty()) return;
    result_.setup.colour = {0.1, 0.085, 0.07};
    note("the model has no colours of its own (pictures are not read): colour makes it grey");
  }

  const Model& model_;
  RigProposal result_;
  std::vector<Limb> limbs_;
  std::vector<std::string> groupOf_;
  glm::dvec3 up_{0, 1, 0}, forward_{0, 0, 1}, left_{1, 0, 0};
  double middle_ = 0;  // of the body, along left_
};

}  // namespace

RigProposal proposeRig(const Model& model) { return Proposer(model).propose(); }

}  // namespace skitter

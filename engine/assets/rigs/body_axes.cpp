#include "assets/rigs/body_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "assets/rigs/clip_heading.h"
#include "assets/rigs/joint_names.h"
#include "assets/rigs/limb_pairs.h"

namespace skitter {
namespace {

constexpr double degreesARadian = 180 / std::numbers::pi;
constexpr size_t mostSamples = 400;  // of the mesh, when it is tried for symmetry

constexpr double certain = 0.5;  // of the confidence: below it a note says how to turn the creature round

constexpr const char* headWords[] = {"head*",   "neck*",    "jaw*",      "eye*",   "nose*", "snout*",
                                     "muzzle*", "face",     "skull*",    "mouth*", "fang*", "tooth",
                                     "teeth",   "tongue*",  "beak*",     "horn*",  "ear",   "ears",
                                     "pincer*", "antenna*", "chelicera*"};
constexpr const char* tailWords[] = {"tail*", "abdomen*", "spinneret*", "stinger*"};
constexpr const char* frontWords[] = {"front*", "fore*", "forward"};
constexpr const char* backWords[] = {"back*", "rear*", "hind*"};
constexpr const char* poleWords[] = {"pole*", "pt"};

double averageMiss(const std::vector<glm::dvec3>& from, const std::vector<glm::dvec3>& to,
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

// Skin that follows no limb; all of it where there is too little.
std::vector<glm::dvec3> bodySkin(const BodyPlan& plan) {
  std::vector<bool> inLimb(plan.model.nodes.size(), false);
  for (const Limb& limb : plan.limbs)
    for (size_t j = limb.inBody; j < limb.joints.size(); ++j)
      inLimb[static_cast<size_t>(limb.joints[j])] = true;
  std::vector<glm::dvec3> body, all;
  for (const int i : plan.model.parentsFirst) {
    const auto node = static_cast<size_t>(i);
    const int parent = plan.model.nodes[node].parent;
    inLimb[node] = inLimb[node] || (parent != -1 && inLimb[static_cast<size_t>(parent)]);
    for (const size_t v : plan.skin[node]) {
      all.push_back(plan.model.vertices[v].position);
      if (!inLimb[node]) body.push_back(all.back());
    }
  }
  return body.size() < 8 ? all : body;
}

// How far the model is from its own mirror image across `side`: shares of the reach, 0 is symmetric.
double asymmetry(const BodyPlan& plan, const glm::dvec3& side) {
  glm::dvec3 centre(0);
  double reach = 0;
  for (const Limb& limb : plan.limbs) {
    centre += plan.at(limb.root()) / static_cast<double>(plan.limbs.size());
    reach = std::max(reach, limb.reach);
  }
  const Pairing pairing = pairingAcross(plan, side);
  if (pairing.share > 0) centre += side * (pairing.middle - glm::dot(centre, side));
  // Legs may rest in mid-stride; what they hang from is as symmetric as the creature.
  std::vector<glm::dvec3> points;
  for (const Limb& limb : plan.limbs) points.push_back(plan.at(limb.root()));
  double sum = averageMiss(points, points, centre, side);
  std::vector<glm::dvec3> mesh = bodySkin(plan);
  if (mesh.size() > 4 * mostSamples) {
    const size_t stride = mesh.size() / (4 * mostSamples) + 1;
    for (size_t k = 0; k * stride < mesh.size(); ++k) mesh[k] = mesh[k * stride];
    mesh.resize((mesh.size() - 1) / stride + 1);
  }
  std::vector<glm::dvec3> samples;
  for (size_t v = 0; v < mesh.size(); v += mesh.size() / mostSamples + 1) samples.push_back(mesh[v]);
  if (!mesh.empty()) sum += averageMiss(samples, mesh, centre, side);
  // A plane through all limbs mirrors each onto itself, and says nothing.
  return sum / std::max(reach, 1e-9) + 0.3 * (1 - pairing.share);
}

// The axis across the body: from names of left and right, else the best plane of symmetry.
glm::dvec3 findSide(const BodyPlan& plan, glm::dvec3& namedLeft) {
  glm::dvec3 left(0), right(0);
  size_t lefts = 0, rights = 0;
  for (const Limb& limb : plan.limbs) {
    const int side = sideOf(wordsOf(plan.model, limb.joints));
    if (side == 0) continue;
    (side > 0 ? left : right) += plan.flat(plan.at(limb.root()));
    ++(side > 0 ? lefts : rights);
  }
  left /= std::max<double>(static_cast<double>(lefts), 1);
  right /= std::max<double>(static_cast<double>(rights), 1);
  const glm::dvec3 front = std::fabs(plan.up.z) < 0.5 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, -plan.up.z, 0);
  const glm::dvec3 across = glm::cross(plan.up, front);
  if (lefts > 0 && rights > 0 && 2 * (lefts + rights) >= plan.limbs.size() &&
      glm::length(left - right) > 1e-9) {
    namedLeft = glm::normalize(left - right);
    glm::dvec3 axis =
        std::fabs(glm::dot(across, namedLeft)) > std::fabs(glm::dot(front, namedLeft)) ? across : front;
    if (glm::dot(axis, namedLeft) < 0) axis = -axis;
    // A model stands along its axes. One foot before the other turns the line between them, so a plane
    // aslant must mirror the model clearly better.
    if (glm::dot(axis, namedLeft) > 0.99 || asymmetry(plan, namedLeft) > 0.6 * asymmetry(plan, axis))
      namedLeft = axis;
    return namedLeft;
  }
  glm::dvec3 best = across;
  double least = asymmetry(plan, across);
  // The file's own axes first: another plane must be clearly better.
  if (const double value = asymmetry(plan, front); value < 0.8 * least - 0.002) {
    least = value;
    best = front;
  }
  if (least < 0.05) return best;
  for (int k = 1; k < 36; ++k) {
    const double angle = k * 5 / degreesARadian;
    const glm::dvec3 side = across * std::cos(angle) + front * std::sin(angle);
    if (const double value = asymmetry(plan, side); value < 0.6 * least) {
      least = value;
      best = side;
    }
  }
  return best;
}

// What --forward takes: an axis, or three numbers.
std::string optionOf(const glm::dvec3& direction) {
  const std::string text = describe(direction);
  return text.front() == '(' ? fmt::format("{:.3f},{:.3f},{:.3f}", direction.x, direction.y, direction.z)
                             : text;
}

double middleAlong(const BodyPlan& plan, const glm::dvec3& side) {
  double sum = 0;
  for (const Limb& limb : plan.limbs)
    sum += glm::dot(plan.at(limb.root()), side) / static_cast<double>(plan.limbs.size());
  return sum;
}

// Evidence for one of the two ways along the body. Each voice is from -1 to 1, times what it weighs.
class ForwardVote {
 public:
  ForwardVote(const BodyPlan& plan, const glm::dvec3& axis) : plan_(plan), axis_(axis) {
    for (const Limb& limb : plan.limbs) {
      reach_ = std::max(reach_, limb.reach);
      middle_ += along(plan.at(limb.root())) / static_cast<double>(plan.limbs.size());
    }
    reach_ = std::max(reach_, 1e-9);
  }

  void count() {
    add("clips that walk", headingOfClips(plan_, axis_), 4);
    hearToes();
    hearLegNames();
    hearBodyNames();
    hearSides();
    hearKnees();
    // A glTF model faces +Z unless something says otherwise; across that, +X is as good as -X.
    if (std::fabs(axis_.z) > 1e-6)
      add("the +Z of glTF", axis_.z > 0 ? 1 : -1, 0.25);
    else
      sum_ += axis_.x > 0 ? 1e-6 : -1e-6;
  }

  glm::dvec3 forward() const { return sum_ < 0 ? -axis_ : axis_; }
  // All that speaks for it less what speaks against it, of all there is; a single weak voice says little.
  double confidence() const { return std::fabs(sum_) / (all_ + 0.5); }

  std::string reason() const {
    std::vector<std::string> fors, against;
    for (const Voice& voice : voices_) {
      if (std::fabs(voice.value) < 0.05) continue;
      (voice.value * sum_ >= 0 ? fors : against).push_back(voice.name);
    }
    std::string text =
        fmt::format("forward is {}: by {}", describe(forward()),
                    fors.empty() ? "symmetry alone" : fmt::format("{}", fmt::join(fors, ", ")));
    if (!against.empty()) text += fmt::format("; against {}", fmt::join(against, ", "));
    text += fmt::format(" (confidence {:.2f})", confidence());
    if (confidence() < certain)
      text += fmt::format("; doubtful: `skitter rig --forward {}` turns it round", optionOf(-forward()));
    return text;
  }

 private:
  struct Voice {
    std::string name;
    double value;
  };

  double along(const glm::dvec3& p) const { return glm::dot(p, axis_); }

  void add(const char* name, double value, double weight) {
    voices_.push_back({name, std::clamp(value, -1.0, 1.0) * weight});
    sum_ += voices_.back().value;
    all_ += std::fabs(voices_.back().value);
  }

  // Toes are ahead of ankles.
  void hearToes() {
    double sum = 0;
    size_t count = 0;
    for (const Limb& limb : plan_.limbs) {
      const std::vector<glm::dvec3> points = plan_.pointsOf(limb);
      if (points.size() < 2) continue;
      const glm::dvec3 bone = points.back() - points[points.size() - 2];
      // The last bone of a leg that ends in a point is a shank.
      if (!limb.sole && std::fabs(plan_.height(bone)) > 0.18 * limb.reach) continue;
      const glm::dvec3 foot = limb.sole ? limb.toes : plan_.flat(bone);
      // A foot that is short, or turned out, says less.
      sum += along(foot) / std::max(glm::length(foot), 0.08 * limb.reach);
      ++count;
    }
    if (count > 0) add("toes", sum / static_cast<double>(count), 3);
  }

  void hearLegNames() {
    double sums[2] = {};
    size_t counts[2] = {};
    for (const Limb& limb : plan_.limbs) {
      const std::vector<std::string> words = wordsOf(plan_.model, limb.chain);
      const bool front = hasWord(words, frontWords), back = hasWord(words, backWords);
      if (front == back) continue;
      sums[front ? 0 : 1] += along(plan_.at(limb.root())) - middle_;
      ++counts[front ? 0 : 1];
    }
    if (counts[0] + counts[1] == 0) return;
    for (const size_t k : {size_t{0}, size_t{1}})
      sums[k] /= std::max<double>(static_cast<double>(counts[k]), 1);
    add("legs named front or back", (sums[0] - sums[1]) / (0.2 * reach_), 4);
  }

  void hearBodyNames() {
    struct Kind {
      const char* name;
      Words words;
      double weight, share;
    };
    const Kind kinds[] = {
        {"head", headWords, 2, 0.25}, {"tail", tailWords, -2, 0.25}, {"pole targets", poleWords, 0.5, 0.5}};
    for (const Kind& kind : kinds) {
      double sum = 0;
      size_t count = 0;
      for (const Model::Node& node : plan_.model.nodes) {
        const std::vector<std::string> words = wordsOf(node.name);
        if (!node.joint || !hasWord(words, kind.words)) continue;
        const bool pole = kind.words.data() == poleWords;
        // Elbows' targets lie behind, and other targets anywhere.
        if (hasWord(words, armWords) || (!pole && hasWord(words, helperWords))) continue;
        sum += along(node.position()) - middle_;
        ++count;
      }
      if (count == 0) continue;
      const double value = sum / static_cast<double>(count) / (kind.share * reach_);
      add(kind.name, kind.weight < 0 ? -value : value, std::fabs(kind.weight));
    }
  }

  void hearSides() {
    double sum = 0;
    size_t count = 0;
    for (const Limb& limb : plan_.limbs) {
      const int side = sideOf(wordsOf(plan_.model, limb.chain));
      if (side == 0) continue;
      // Where the body's left is if it walks along the axis.
      const double across = glm::dot(plan_.at(limb.root()), glm::cross(plan_.up, axis_)) -
                            middleAlong(plan_, glm::cross(plan_.up, axis_));
      sum += side * across > 0 ? 1 : -1;
      ++count;
    }
    if (count > 0) add("joints named left and right", sum / static_cast<double>(count), 1);
  }

  // Those of two legs bend forward; elbows and hocks of four do not.
  void hearKnees() {
    if (plan_.limbs.size() != 2) return;
    double sum = 0;
    for (const Limb& limb : plan_.limbs) {
      const std::vector<glm::dvec3> points = plan_.pointsOf(limb);
      const size_t end = points.size() - (limb.sole ? 2 : 1);
      if (end < 2) continue;
      const glm::dvec3 chord = points[end] - points.front();
      if (!(glm::length(chord) > 0)) continue;
      const glm::dvec3 knee = points[1] - points.front();
      sum += along(knee - chord * (glm::dot(knee, chord) / glm::dot(chord, chord))) / limb.reach;
    }
    add("knees", 0.5 * sum / 0.05, 0.75);
  }

  const BodyPlan& plan_;
  const glm::dvec3 axis_;
  double reach_ = 0, middle_ = 0, sum_ = 0, all_ = 0;
  std::vector<Voice> voices_;
};

}  // namespace

// glTF is +Y up; another axis only where that leaves fewer than two legs.
void chooseUp(BodyPlan& plan) {
  const glm::dvec3 axes[] = {{0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, -1, 0}};
  for (const glm::dvec3& axis : axes) {
    LimbSearch search = findLimbs(plan.model, plan.skin, axis, footShare);
    if (axis.y == 1) plan.notes = search.notes;
    if (search.limbs.size() <= plan.limbs.size() || (search.limbs.size() < 2 && axis.y < 1)) continue;
    plan.up = axis;
    plan.limbs = std::move(search.limbs);
    plan.notes = std::move(search.notes);
    if (plan.limbs.size() >= 2) break;
  }
  if (plan.up.y < 1) plan.note(fmt::format("up is {}: along +Y no legs stand", describe(plan.up)));
}

void findAcross(BodyPlan& plan) {
  glm::dvec3 namedLeft(0);
  plan.left = findSide(plan, namedLeft);
}

void chooseForward(BodyPlan& plan, const std::optional<glm::dvec3>& given) {
  const glm::dvec3 axis = glm::cross(plan.left, plan.up);
  if (given) {
    plan.forward = glm::normalize(plan.flat(*given));
    plan.note(fmt::format("forward is {}: as it was given", describe(plan.forward)));
  } else {
    ForwardVote vote(plan, axis);
    vote.count();
    plan.forward = vote.forward();
    plan.confidence = vote.confidence();
    plan.note(vote.reason());
  }
  const glm::dvec3 left = glm::cross(plan.up, plan.forward);
  plan.middle *= glm::dot(left, plan.left) < 0 ? -1 : 1;
  if (given && std::fabs(glm::dot(left, plan.left)) < 0.99) plan.middle = middleAlong(plan, left);
  plan.left = left;
}

std::string describe(const glm::dvec3& v) {
  for (int k = 0; k < 3; ++k) {
    if (std::fabs(v[k]) > 1 - 1e-9) return fmt::format("{}{}", v[k] > 0 ? '+' : '-', "XYZ"[k]);
  }
  return fmt::format("({:.3f}, {:.3f}, {:.3f})", v.x, v.y, v.z);
}

}  // namespace skitter

#include "assets/rigs/body_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace skitter {
namespace {

constexpr double degreesARadian = 180 / std::numbers::pi;
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

// How far the model is from its own mirror image across `side`: shares of the reach, 0 is symmetric.
double asymmetry(const BodyPlan& plan, const glm::dvec3& side) {
  glm::dvec3 centre(0);
  double reach = 0;
  for (const Limb& limb : plan.limbs) {
    centre += limb.tip / static_cast<double>(plan.limbs.size());
    reach = std::max(reach, limb.reach);
  }
  std::vector<glm::dvec3> points;
  for (const Limb& limb : plan.limbs) {
    points.push_back(limb.tip);
    points.push_back(plan.at(limb.root()));
  }
  double sum = averageMiss(points, points, centre, side);
  std::vector<glm::dvec3> mesh;
  const size_t stride = plan.model.vertices.size() / (4 * mostSamples) + 1;
  for (size_t v = 0; v < plan.model.vertices.size(); v += stride)
    mesh.push_back(plan.model.vertices[v].position);
  std::vector<glm::dvec3> samples;
  for (size_t v = 0; v < mesh.size(); v += mesh.size() / mostSamples + 1) samples.push_back(mesh[v]);
  if (!mesh.empty()) sum += averageMiss(samples, mesh, centre, side);
  return sum / std::max(reach, 1e-9);
}

// The axis across the body: from names of left and right, else the best plane of symmetry.
glm::dvec3 findSide(const BodyPlan& plan, glm::dvec3& namedLeft) {
  glm::dvec3 left(0), right(0);
  size_t lefts = 0, rights = 0;
  for (const Limb& limb : plan.limbs) {
    std::vector<std::string> words;
    for (int joint : limb.joints) {
      for (std::string& word : wordsOf(plan.model.nodes[static_cast<size_t>(joint)].name))
        words.push_back(std::move(word));
    }
    const bool isLeft = hasWord(words, std::array{"l", "left"}),
               isRight = hasWord(words, std::array{"r", "right"});
    if (isLeft == isRight) continue;
    (isLeft ? left : right) += plan.flat(limb.tip);
    ++(isLeft ? lefts : rights);
  }
  const glm::dvec3 front = std::fabs(plan.up.z) < 0.5 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, -plan.up.z, 0);
  const glm::dvec3 across = glm::cross(plan.up, front);
  if (lefts == rights && 2 * lefts >= plan.limbs.size() && glm::length(left - right) > 1e-9) {
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

}  // namespace

// glTF is +Y up; another axis only where that leaves fewer than two legs.
void chooseUp(BodyPlan& plan) {
  const glm::dvec3 axes[] = {{0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, -1, 0}};
  for (const glm::dvec3& axis : axes) {
    const std::vector<Limb> limbs = findLimbs(plan.model, axis);
    if (limbs.size() <= plan.limbs.size() || (limbs.size() < 2 && axis.y < 1)) continue;
    plan.up = axis;
    plan.limbs = limbs;
    if (limbs.size() >= 2) break;
  }
  if (plan.up.y < 1) plan.note(fmt::format("up is {}: along +Y no legs stand", describe(plan.up)));
}

void chooseForward(BodyPlan& plan) {
  glm::dvec3 namedLeft(0);
  const glm::dvec3 side = findSide(plan, namedLeft);
  plan.forward = glm::cross(side, plan.up);
  double extent = 0;
  glm::dvec3 sums[3] = {};  // front, back, all
  double counts[3] = {};
  for (size_t i = 0; i < plan.model.nodes.size(); ++i) {
    if (!plan.model.nodes[i].joint) continue;
    const std::vector<std::string> words = wordsOf(plan.model.nodes[i].name);
    const glm::dvec3 p = plan.model.nodes[i].position();
    for (const size_t kind : {size_t{0}, size_t{1}, size_t{2}}) {
      if (kind == 0 && !hasWord(words, frontWords)) continue;
      if (kind == 1 && !hasWord(words, backWords)) continue;
      sums[kind] += p;
      ++counts[kind];
    }
  }
  for (const Limb& limb : plan.limbs) extent = std::max(extent, limb.reach);
  for (size_t kind = 0; kind < 3; ++kind) sums[kind] /= std::max(counts[kind], 1.0);
  const glm::dvec3 named = (counts[0] > 0 ? sums[0] : sums[2]) - (counts[1] > 0 ? sums[1] : sums[2]);
  const double along = glm::dot(named, plan.forward);
  const bool leftSays = glm::length(namedLeft) > 0;
  std::string evidence;
  if (std::fabs(along) > 0.02 * extent) {
    if (along < 0) plan.forward = -plan.forward;
    evidence = "joint names of head or tail, front or back";
    if (leftSays && glm::dot(glm::cross(namedLeft, plan.up), plan.forward) < 0) {
      plan.note("joints named left are on the creature's right: legs are named by where they are");
    }
  } else if (leftSays) {
    evidence = "joint names of left and right";
  } else {
    if (plan.forward.z < -1e-6 || (std::fabs(plan.forward.z) <= 1e-6 && plan.forward.x < 0))
      plan.forward = -plan.forward;
    evidence = "symmetry alone, so it may be the other way round";
  }
  plan.note(fmt::format("forward is {}: by {}", describe(plan.forward), evidence));
  plan.left = glm::cross(plan.up, plan.forward);
}

std::string describe(const glm::dvec3& v) {
  for (int k = 0; k < 3; ++k) {
    if (std::fabs(v[k]) > 1 - 1e-9) return fmt::format("{}{}", v[k] > 0 ? '+' : '-', "XYZ"[k]);
  }
  return fmt::format("({:.3f}, {:.3f}, {:.3f})", v.x, v.y, v.z);
}

}  // namespace skitter

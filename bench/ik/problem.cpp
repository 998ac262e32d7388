#include "bench/ik/problem.h"

#include <numbers>
#include <stdexcept>

namespace skitter::bench {
namespace {

using baseline::LimitKind;

constexpr float degree = std::numbers::pi_v<float> / 180;

baseline::Limit cone(float degrees) {
  baseline::Limit limit;
  limit.kind = LimitKind::cone;
  limit.cone = degrees * degree;
  return limit;
}

baseline::Limit ellipse() {
  baseline::Limit limit;
  limit.kind = LimitKind::ellipse;
  limit.positiveX = 30 * degree, limit.positiveY = 70 * degree;
  limit.negativeX = 40 * degree, limit.negativeY = 20 * degree;
  return limit;
}

// About the normal of the plane in which the chain rests.
baseline::Limit hinge() {
  baseline::Limit limit;
  limit.kind = LimitKind::hinge;
  limit.axis = {0, 0, 1};
  limit.low = -60 * degree, limit.high = 60 * degree;
  return limit;
}

baseline::Limit limitNamed(const std::string& name) {
  if (name == "none") return {};
  if (name == "cone90" || name == "caliko") return cone(90);
  if (name == "cone60") return cone(60);
  if (name == "cone30") return cone(30);
  if (name == "ellipse") return ellipse();
  if (name == "hinge" || name == "hinge-free-base") return hinge();
  throw std::invalid_argument("no limits are called " + name);
}

glm::vec3 vectorOf(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

ik::Limit deviceLimit(const baseline::Limit& limit) {
  switch (limit.kind) {
    case LimitKind::free:
      return ik::Free{};
    case LimitKind::cone:
      return ik::Cone{limit.cone};
    case LimitKind::ellipse:
      return ik::Ellipse{limit.positiveX, limit.positiveY, limit.negativeX, limit.negativeY};
    case LimitKind::hinge:
      return ik::Hinge{vectorOf(limit.axis), limit.low, limit.high};
  }
  return {};
}

bool isDissertation(ik::Solver solver) {
  return solver == ik::Solver::dissertationKeep || solver == ik::Solver::dissertationEdge;
}

}  // namespace

const std::vector<std::string>& allLimits() {
  static const std::vector<std::string> all = {"none",    "cone90", "cone60",          "cone30",
                                               "ellipse", "hinge",  "hinge-free-base", "caliko"};
  return all;
}

baseline::Chain chainWith(const std::string& limits, int joints) {
  baseline::Chain chain = baseline::bentChain(joints - 1, limitNamed(limits));
  if (limits == "hinge-free-base" || limits == "caliko") chain.bones.front().limit = {};
  if (limits == "caliko")
    for (baseline::Bone& bone : chain.bones) bone.rest = {1, 0, 0};
  return chain;
}

ik::Chain deviceChain(const baseline::Chain& chain) {
  ik::Chain made;
  for (const baseline::Bone& bone : chain.bones) {
    made.bones.push_back(
        {.length = bone.length, .direction = vectorOf(bone.rest), .limit = deviceLimit(bone.limit)});
  }
  return made;
}

const std::vector<Entry>& allEntries() {
  using ik::Solver;
  static const std::vector<Entry> all = {
      {"fabrik", Solver::fabrik, baseline::Solver::fabrik},
      {"stretch-align", Solver::stretchAlign, baseline::Solver::stretchAlign},
      {"active-set", Solver::activeSet, baseline::Solver::activeSet},
      {"active-set-alone", Solver::activeSet, {}, false},
      {"two-bone", Solver::twoBone},
      {"dissertation-keep", Solver::dissertationKeep},
      {"dissertation-edge", Solver::dissertationEdge},
      {"ccd", Solver::ccd},
      {"transpose", Solver::transpose},
      {"pseudoinverse", Solver::pseudoinverse},
      {"dls", Solver::dampedLeastSquares},
      {"target-attached", Solver::targetAttached},
  };
  return all;
}

bool takes(const Entry& entry, const std::string& limits, int joints) {
  const bool free = limits == "none";
  if (entry.device == ik::Solver::twoBone) return free && joints == 3;
  if (entry.device == ik::Solver::stretchAlign) return free;
  if (entry.device == ik::Solver::activeSet) return !free;
  if (isDissertation(entry.device)) return limits.starts_with("cone") || limits == "caliko";
  return true;
}

bool keepsLengths(const Entry& entry) { return entry.device != ik::Solver::dissertationKeep; }
bool keepsLimits(const Entry& entry) { return !isDissertation(entry.device); }

Targets::Targets(std::vector<baseline::Rows> given, size_t chains) : rows(std::move(given)) {
  for (const baseline::Rows& set : rows) {
    std::vector<glm::vec3>& made = vectors.emplace_back();
    for (size_t c = 0; c < chains; ++c) made.emplace_back(set.at(0, c), set.at(1, c), set.at(2, c));
  }
}

}  // namespace skitter::bench

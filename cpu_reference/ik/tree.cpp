#include "cpu_reference/ik/tree.h"

#include <algorithm>
#include <stdexcept>

#include "cpu_reference/ik/fabrik.h"
#include "cpu_reference/ik/loop.h"

namespace skitter::reference {

IkTree IkTree::of(const std::vector<std::vector<double>>& lengths, const std::vector<glm::dvec3>& offsets) {
  if (lengths.empty() || lengths.size() != offsets.size()) {
    throw std::invalid_argument("a tree has legs, and an offset for each");
  }
  IkTree tree;
  for (size_t b = 0; b < lengths.size(); ++b) {
    Leg leg;
    leg.offset = offsets[b];
    for (const double length : lengths[b]) {
      if (!(length >= 0)) throw std::invalid_argument("a bone's length must be at least 0");
      leg.bones.emplace_back().length = length;
    }
    if (leg.bones.empty()) throw std::invalid_argument("a leg has bones");
    tree.legs.push_back(leg);
  }
  return tree;
}

double IkTree::longestLeg() const {
  double longest = 0;
  for (const Leg& leg : legs) {
    double length = 0;
    for (const BoneRest& bone : leg.bones) length += bone.length;
    longest = std::max(longest, length);
  }
  return longest;
}

double treeError(const IkTree& tree, std::span<const glm::dvec3> targets, const IkTreeState& state) {
  double worst = 0;
  for (size_t b = 0; b < targets.size(); ++b) {
    worst = std::max(worst, glm::length(targets[b] - state.legs[b].back()));
  }
  return worst / tree.longestLeg();
}

void iterateTree(const IkTree& tree, std::span<const glm::dvec3> targets, IkTreeState& state) {
  std::vector<Joints> proposed;
  glm::dvec3 sum(0);
  for (size_t b = 0; b < tree.legs.size(); ++b) {
    proposed.push_back(tipToBase(tree.legs[b].bones, targets[b], state.legs[b]));
    sum += proposed[b][0] - tree.legs[b].offset;
  }
  const glm::dvec3 mean = sum / static_cast<double>(tree.legs.size());
  state.body = glm::mix(mean, tree.anchor, tree.anchorShare);
  for (size_t b = 0; b < tree.legs.size(); ++b) {
    state.legs[b][0] = state.body + tree.legs[b].offset;
    baseToTip(tree.legs[b].bones, proposed[b], state.legs[b]);
  }
}

IkTreeResult solveTree(const IkTree& tree, std::span<const glm::dvec3> targets, const IkTreeState& start,
                       double tolerance, int iterations) {
  const bool finite = std::all_of(targets.begin(), targets.end(), [](const glm::dvec3& t) {
    return std::isfinite(t.x) && std::isfinite(t.y) && std::isfinite(t.z);
  });
  if (!finite) return {start, 0, 0, IkStop::skipped};
  const auto loop = iterateUntilDone(
      {.tolerance = tolerance}, iterations, start, start,
      [&](const IkTreeState& s) { return treeError(tree, targets, s); },
      [&](int, IkTreeState& s) { iterateTree(tree, targets, s); });
  return {loop.best, loop.error, loop.iterations, loop.stop};
}

}  // namespace skitter::reference

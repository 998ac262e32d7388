#pragma once

#include <span>

#include "cpu_reference/ik/chain.h"
#include "cpu_reference/ik/solve.h"

// A body with its legs as one solve: FABRIK with several ends (Aristidou & Lasenby 2011). The body moves but
// does not turn, the legs have no limits. Any unit of length.
namespace skitter::reference {

struct IkTree {
  struct Leg {
    std::vector<BoneRest> bones;  // of which only the lengths matter here
    glm::dvec3 offset{0};         // o_b: of the root from the body
  };
  std::vector<Leg> legs;
  glm::dvec3 anchor{0};
  double anchorShare = 0;  // a: 0, the body floats; 1, it stays at the anchor

  // From the lengths of each leg's bones and its root's offset. std::invalid_argument where there is no leg,
  // a leg has no bone, or a length is negative.
  static IkTree of(const std::vector<std::vector<double>>& lengths, const std::vector<glm::dvec3>& offsets);
  double longestLeg() const;
};

struct IkTreeState {
  glm::dvec3 body{0};
  std::vector<Joints> legs;  // of each leg, root first, not relative to the body
};

struct IkTreeResult {
  IkTreeState state;
  double error = 0;  // the largest of the legs', share of the longest leg
  int iterations = 0;
  IkStop stop = IkStop::skipped;
};

// The largest distance of a tip from its target, share of the longest leg.
double treeError(const IkTree& tree, std::span<const glm::dvec3> targets, const IkTreeState& state);

// One iteration.
void iterateTree(const IkTree& tree, std::span<const glm::dvec3> targets, IkTreeState& state);

IkTreeResult solveTree(const IkTree& tree, std::span<const glm::dvec3> targets, const IkTreeState& start,
                       double tolerance, int iterations);

}  // namespace skitter::reference

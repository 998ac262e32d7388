#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/split_mix.h"
#include "crowd/regait.h"
#include "skitter/rig.h"
#include "skitter/tuning.h"

namespace skitter::evolve {

using Genes = std::vector<uint16_t>;

// What candidates are made of, for one rig (docs/evolve.md).
class GeneSpace {
 public:
  static constexpr double longestCycle = 1;  // seconds, at the speed that the candidate wants to have

  // `wanted`: leg lengths per second that creatures in trials want to go.
  GeneSpace(const Rig& rig, const Tuning& tuning, double wanted);

  size_t count() const { return firstTurn + 2 * legs_; }
  RigGait decode(std::span<const uint16_t> genes, uint32_t idle) const;
  // The genes that make this gait, as nearly as genes can.
  Genes encode(const crowd::Regait& gait, uint32_t idle) const;
  Genes drawn(base::SplitMix64& random) const;
  // A child of `elite`, varied along the line to `other`.
  Genes varied(const Genes& elite, const Genes& other, base::SplitMix64& random) const;

 private:
  static constexpr size_t groupsGene = 0, adjacentGene = 1, slownessGene = 2, shiftXGene = 3, shiftZGene = 4,
                          loweringGene = 5, speedGene = 6, firstTurn = 7;
  bool isPhase(size_t gene) const { return gene >= firstTurn && gene < firstTurn + legs_; }
  uint32_t mostGroups(uint32_t idle) const;
  // Seconds of a usual step at a share of the wanted speed.
  double stepTime(double speed) const;

  size_t legs_;
  double wanted_;
  double swingStill_, swingSpeed_, windowSlack_;
  double legLength_, bodyHeight_;
};

}  // namespace skitter::evolve

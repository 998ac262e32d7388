#include "evolve/genes.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace skitter::evolve {
namespace {

constexpr double geneEnd = 65536;

// A range of what a gene makes.
struct Span {
  double least, most;

  double of(uint16_t gene) const { return least + (most - least) * (gene / geneEnd); }
  uint16_t geneOf(double value) const {
    const double share = (value - least) / (most - least);
    return static_cast<uint16_t>(std::clamp(std::floor(share * geneEnd + 0.5), 0.0, geneEnd - 1));
  }
};
constexpr Span commonSlowness{0.8, 1.3}, ownSlowness{0.9, 1.1}, loweringSpan{-0.1, 0.3}, speedSpan{0.5, 1};
constexpr uint32_t mostTurns = 5;
// Leg lengths. Most homes shift little, so most genes stand for little.
constexpr double mostShift = 0.7;

double shiftOf(uint16_t gene) {
  const double x = 2 * (gene / geneEnd) - 1;
  return mostShift * x * x * x;
}
uint16_t geneOfShift(double shift) {
  const double x = std::cbrt(shift / mostShift);
  return static_cast<uint16_t>(std::clamp(std::floor((x + 1) / 2 * geneEnd + 0.5), 0.0, geneEnd - 1));
}

// Iso-line variation (Vassiliades & Mouret 2018).
constexpr double isoShare = 0.02, lineShare = 0.2;
constexpr uint64_t drawnAnewOf = 16;  // one gene in so many

// Near a normal deviate, with variance 1: without a function whose last bit differs between libraries.
double normalOf(uint64_t draw) {
  double sum = 0;
  for (int part = 0; part < 4; ++part) sum += static_cast<double>(draw >> 16 * part & 0xffffu);
  constexpr double mean = 2 * (geneEnd - 1), deviation = 0.57735026918962576 * geneEnd;
  return (sum - mean) / deviation;
}

bool isCarrier(uint32_t idle, size_t leg) { return (idle >> leg & 1u) == 0; }

// The shorter way around the cycle.
double phaseWay(uint16_t from, uint16_t to) {
  const auto way = static_cast<double>(to - from);
  return way - geneEnd * std::floor(way / geneEnd + 0.5);
}

}  // namespace

GeneSpace::GeneSpace(const Rig& rig, const Tuning& tuning, double wanted)
    : legs_(rig.legs.size()),
      wanted_(wanted),
      swingStill_(double{tuning.swingStill}),
      swingSpeed_(double{tuning.swingSpeed}),
      windowSlack_(double{tuning.windowSlack}),
      legLength_(double{rig.legLength}),
      bodyHeight_(double{rig.bodyHeight}) {}

uint32_t GeneSpace::mostGroups(uint32_t idle) const {
  return std::min(mostTurns, static_cast<uint32_t>(legs_) - static_cast<uint32_t>(std::popcount(idle)));
}

double GeneSpace::stepTime(double speed) const { return swingStill_ / (1 + speed * wanted_ / swingSpeed_); }

RigGait GeneSpace::decode(std::span<const uint16_t> genes, uint32_t idle) const {
  const double most = double{RigGait::maxShift};
  RigGait gait;
  gait.idle = idle;
  gait.groups = 2 + uint32_t{genes[groupsGene]} * (mostGroups(idle) - 1) / static_cast<uint32_t>(geneEnd);
  gait.adjacent = genes[adjacentGene] >= geneEnd / 2;
  const double lowering = loweringSpan.of(genes[loweringGene]) * bodyHeight_ / legLength_;
  gait.shift = {shiftOf(genes[shiftXGene]), std::clamp(lowering, -most, most), shiftOf(genes[shiftZGene])};
  const double speed = speedSpan.of(genes[speedGene]);
  gait.speed = static_cast<float>(speed);
  gait.turns.resize(legs_);
  const double common = commonSlowness.of(genes[slownessGene]);
  double slowest = 1;  // the cycle has room for usual steps in any case
  for (size_t leg = 0; leg < legs_; ++leg)
    if (isCarrier(idle, leg))
      slowest = std::max(slowest, common * ownSlowness.of(genes[firstTurn + legs_ + leg]));
  const double cycle = gait.groups * stepTime(speed) * windowSlack_ * slowest;
  const double shorter = std::min(1.0, longestCycle / cycle);
  for (size_t leg = 0; leg < legs_; ++leg) {
    if (!isCarrier(idle, leg)) continue;
    const double slowness = shorter * common * ownSlowness.of(genes[firstTurn + legs_ + leg]);
    gait.turns[leg] = {static_cast<float>(genes[firstTurn + leg] / geneEnd),
                       static_cast<float>(std::max(slowness, double{RigGait::minSlowness}))};
  }
  return gait;
}

Genes GeneSpace::encode(const crowd::Regait& gait, uint32_t idle) const {
  Genes genes(count());
  const uint32_t most = mostGroups(idle);
  const uint32_t groups = std::clamp(static_cast<uint32_t>(gait.groups), 2u, most);
  genes[groupsGene] = static_cast<uint16_t>((groups - 2 + 0.5) * geneEnd / (most - 1));
  genes[slownessGene] = commonSlowness.geneOf(1);
  genes[shiftXGene] = geneOfShift(double{gait.shift.x} / legLength_);
  genes[shiftZGene] = geneOfShift(double{gait.shift.z} / legLength_);
  genes[loweringGene] = loweringSpan.geneOf(double{gait.shift.y} / bodyHeight_);
  genes[speedGene] = speedSpan.geneOf(double{gait.speed});
  for (size_t leg = 0; leg < legs_; ++leg) {
    const crowd::LegTurn& turn = gait.legs[leg];
    const double phase = (turn.group + double{turn.within}) / gait.groups;
    // Up, so that no rounding puts a leg at the end of the turn before.
    genes[firstTurn + leg] = static_cast<uint16_t>(static_cast<uint32_t>(std::ceil(phase * geneEnd)));
    genes[firstTurn + legs_ + leg] = ownSlowness.geneOf(double{turn.slowness});
  }
  return genes;
}

Genes GeneSpace::drawn(base::SplitMix64& random) const {
  Genes genes(count());
  for (uint16_t& gene : genes) gene = static_cast<uint16_t>(random() >> 48);
  return genes;
}

Genes GeneSpace::varied(const Genes& elite, const Genes& other, base::SplitMix64& random) const {
  Genes child(count());
  const double along = lineShare * normalOf(random());
  for (size_t i = 0; i < child.size(); ++i) {
    const uint64_t draw = random(), choice = random();
    const double way = isPhase(i) ? phaseWay(elite[i], other[i]) : static_cast<double>(other[i] - elite[i]);
    double gene = std::floor(elite[i] + isoShare * geneEnd * normalOf(draw) + along * way + 0.5);
    gene = isPhase(i) ? gene - geneEnd * std::floor(gene / geneEnd) : std::clamp(gene, 0.0, geneEnd - 1);
    child[i] = choice % drawnAnewOf == 0 ? static_cast<uint16_t>(choice >> 48) : static_cast<uint16_t>(gene);
  }
  return child;
}

}  // namespace skitter::evolve

#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "skitter/device.h"
#include "skitter/evolve.h"
#include "skitter/rig.h"

namespace skitter::app {

constexpr double judgedSeconds = 20;

// A gait's worth by measure: the share of the wanted speed that it keeps times the share of time in which it
// is stable, 0 to 1.
double worthOf(const GaitJudgement& judged);

// Those of `gaits` that are worth more than the rule's for the same pattern, and no less stable. All were
// judged in this order.
std::vector<RigGait> betterThanRule(std::span<const RigGait> gaits, std::span<const GaitJudgement> found,
                                    std::span<const GaitJudgement> byRule);

nlohmann::ordered_json jsonOf(const GaitJudgement& judged);
// The names of the legs of a mask.
nlohmann::ordered_json namesOf(const Rig& rig, uint32_t legs);

// How creatures of a rig walk without legs, one of each pattern that a gait is searched for, mirror images
// too: by the rig's table, by the rule alone, and in the gait of whole creatures
// (docs/evolve.md#how-a-table-is-judged).
class TableReport {
 public:
  // Throws Error(input) for a rig without patterns.
  TableReport(Device& device, const Rig& rig, float dt);

  // "intact" and "judgedPatterns".
  nlohmann::ordered_json json() const;
  // A line for each number of legs that do not carry.
  std::string text() const;

 private:
  struct Pattern {
    nlohmann::ordered_json without;
    bool inTable = false;
    GaitJudgement byTable, byRule, unadapted;
  };
  nlohmann::ordered_json jsonOfPattern(const Pattern& pattern) const;
  std::string lineWithout(int idle) const;
  double keptOf(const GaitJudgement& judged) const { return judged.speed / intact_.speed; }

  GaitJudgement intact_;
  std::vector<Pattern> patterns_;
};

}  // namespace skitter::app

#include "app/bench/avoid_report.h"

#include <fmt/format.h>

#include <string>

#include "app/bench/match_report.h"

namespace skitter::app {

using nlohmann::ordered_json;
using namespace bench;

void print(const AvoidMatch& match, uint32_t rounds, bool cpu) {
  fmt::print(
      "\ngrid and avoid, {} agents, {:.3f} m from each other in rows, {:.3f} per footprint's area, "
      "{} rounds; speed by {}\n",
      match.agents, match.spacing, match.density, rounds, cpu ? "CPU time" : "the wall clock");
  fmt::print("neighbours    {:.2f} in reach of an agent, of which it keeps clear of {:.2f}\n", match.inReach,
             match.keptClear);
  printResults(match.agents, match.results, cpu);
  fmt::print("\n{:<22}{}\n", "", "us an agent and tick");
  for (const Result& result : match.results) {
    const bool byCpuTime = cpu || result.threads > 0;
    std::string stages;
    for (const StageTime& stage : result.stages)
      stages +=
          fmt::format("  {} {:.4f}", stage.stage,
                      1e3 * millisecondsOf(stage, result, byCpuTime) / static_cast<double>(match.agents));
    fmt::print("{:<20}{}\n", result.name, stages);
  }
}

void print(const std::vector<Growth>& growth) {
  if (growth.empty()) return;
  fmt::print("\ncost an agent, {} agents against {}\n", growth.front().to, growth.front().from);
  for (const Growth& each : growth) fmt::print("{:<22}{:>10.2f}\n", each.name, each.ratio);
}

ordered_json jsonOf(const AvoidMatch& match) {
  ordered_json results = ordered_json::array();
  for (const Result& result : match.results) results.push_back(jsonOf(result));
  return {{"agents", match.agents},   {"spacing", match.spacing},     {"density", match.density},
          {"inReach", match.inReach}, {"keptClear", match.keptClear}, {"results", results}};
}

ordered_json jsonOf(const std::vector<Growth>& growth) {
  ordered_json all = ordered_json::array();
  for (const Growth& each : growth)
    all.push_back({{"name", each.name}, {"from", each.from}, {"to", each.to}, {"ratio", each.ratio}});
  return all;
}

}  // namespace skitter::app

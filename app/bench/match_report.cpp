#include "app/bench/match_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "crowd/stage.h"

namespace skitter::app {

using nlohmann::ordered_json;
using namespace bench;

namespace {

// What a contestant is judged by: CPU time where the device is one too, else the wall clock.
double costOf(const Result& result, bool cpu) { return cpu ? result.cpu.median : result.wall.median; }

double sumOf(const std::vector<StageTime>& stages) {
  double sum = 0;
  for (const StageTime& stage : stages) sum += stage.milliseconds;
  return sum;
}

// What a stage of the device, or the stages that it makes at once, take an opponent.
StageTime sameOf(const std::vector<StageTime>& stages, const std::string& name) {
  StageTime same{name};
  for (const StageTime& stage : stages)
    if (crowd::makes(name, stage.stage)) same.milliseconds += stage.milliseconds;
  return same;
}

ordered_json jsonOf(const Spread& spread) {
  return {{"median", spread.median}, {"low", spread.low}, {"high", spread.high}};
}

}  // namespace

double millisecondsOf(const StageTime& stage, const Result& result, bool cpu) {
  const double sum = std::max(sumOf(result.stages), 1e-9);
  return std::max(stage.milliseconds / sum * (cpu ? result.cpu.median : sum), 1e-9);
}

ordered_json jsonOf(const Result& result) {
  ordered_json stages = ordered_json::array(), checks = ordered_json::array();
  for (const StageTime& stage : result.stages)
    stages.push_back({{"stage", stage.stage}, {"milliseconds", stage.milliseconds}});
  for (const validation::StageResult& check : result.checks)
    checks.push_back({{"stage", check.name},
                      {"samples", check.samples},
                      {"maxError", check.maxError},
                      {"tolerance", check.tolerance},
                      {"pass", check.pass}});
  return {{"name", result.name},
          {"threads", result.threads},
          {"ticksATurn", result.ticks},
          {"wallMilliseconds", jsonOf(result.wall)},
          {"cpuMilliseconds", jsonOf(result.cpu)},
          {"stages", stages},
          {"checkedTick", result.checkedTick},
          {"checks", checks}};
}

void printResults(uint64_t agentCount, const std::vector<Result>& results, bool cpu) {
  const auto agents = static_cast<double>(agentCount);
  fmt::print("{:<22}{:>7}{:>11}  {:<24}{:>8}{:>18}{:>8}\n", "", "ticks", "ms a tick", "(quartiles)", "CPU ms",
             "core-us an agent", "speed");
  const double device = costOf(results.front(), cpu);
  for (const Result& result : results) {
    const std::string range = fmt::format("({:.3f} to {:.3f})", result.wall.low, result.wall.high);
    fmt::print("{:<22}{:>7}{:>11.3f}  {:<24}{:>8.3f}{:>18.4f}{:>8.2f}{}\n", result.name, result.ticks,
               result.wall.median, range, result.cpu.median,
               agents > 0 ? 1e3 * result.cpu.median / agents : 0, device / costOf(result, cpu),
               result.pass ? "" : "  WRONG");
  }
}

void printStages(const Match& match, const Peaks& peaks, bool cpu) {
  const Result& device = match.results.front();
  const double sum = std::max(sumOf(device.stages), 1e-9);
  const double threads = cpu ? std::max(1u, std::thread::hardware_concurrency()) : 1;
  fmt::print("\n{:<10}{:>11}{:>8}{:>10}{:>10}{:>10}{:>15}", "stage", cpu ? "core-ms" : "ms", "share", "MB",
             "Mop", "of copy", "of arithmetic");
  for (size_t i = 1; i < match.results.size(); ++i) fmt::print("{:>22}", match.results[i].name);
  fmt::print("\n");
  for (const StageTime& stage : device.stages) {
    const auto asked = std::find_if(match.demands.begin(), match.demands.end(),
                                    [&](const StageDemand& d) { return d.stage == stage.stage; });
    if (asked == match.demands.end()) continue;
    const double milliseconds = millisecondsOf(stage, device, cpu), seconds = 1e-3 * milliseconds / threads;
    fmt::print("{:<10}{:>11.3f}{:>7.1f}%{:>10.3f}{:>10.3f}{:>9.1f}%{:>14.1f}%", stage.stage, milliseconds,
               100 * stage.milliseconds / sum, 1e-6 * asked->bytes, 1e-6 * asked->operations,
               100 * asked->bytes / seconds / peaks.bytesPerSecond,
               100 * asked->operations / seconds / peaks.operationsPerSecond);
    for (size_t i = 1; i < match.results.size(); ++i) {
      const Result& other = match.results[i];
      const StageTime same = sameOf(other.stages, stage.stage);
      fmt::print("{:>22}", same.milliseconds > 0
                               ? fmt::format("{:.3f} core-ms", millisecondsOf(same, other, true))
                               : "");
    }
    fmt::print("\n");
  }
}

ordered_json jsonOf(Controller controller, const Match& match) {
  ordered_json results = ordered_json::array(), demands = ordered_json::array();
  for (const Result& result : match.results) results.push_back(jsonOf(result));
  for (const StageDemand& demand : match.demands)
    demands.push_back({{"stage", demand.stage}, {"bytes", demand.bytes}, {"operations", demand.operations}});
  return {{"controller", nameOf(controller)},
          {"agents", match.agents},
          {"memoryBytes", match.memoryBytes},
          {"results", results},
          {"demands", demands}};
}

std::string faultsOf(const std::vector<Result>& results) {
  std::string faults;
  for (const Result& result : results)
    for (const validation::StageResult& check : result.checks)
      if (!check.pass)
        faults += fmt::format("{}{}, {}: {}", faults.empty() ? "" : "; ", result.name, check.name, check.why);
  return faults;
}

}  // namespace skitter::app

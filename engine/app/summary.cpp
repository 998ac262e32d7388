#include "summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace skitter::app {
namespace {

struct Spread {
  double min, median, max;
};

std::optional<Spread> spreadOf(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return Spread{values.front(), 0.5 * (values[(n - 1) / 2] + values[n / 2]), values.back()};
}

std::optional<double> cpuMicroseconds(const Summary& summary) {
  if (!summary.cpuTold || summary.agents == 0 || summary.ticks == 0) return {};
  return 1e6 * summary.times.cpuSeconds /
         (static_cast<double>(summary.agents) * static_cast<double>(summary.ticks));
}

void printRow(const char* name, const std::string& value) { fmt::print("{:<12}{}\n", name, value); }

}  // namespace

void Summary::print() const {
  printRow("device", device);
  printRow("terrain", filledVoids > 0 ? fmt::format("{}, voids filled: {}", terrain, filledVoids) : terrain);
  printRow("agents", fmt::format("{}", agents));
  printRow("ticks", ticks < wantedTicks ? fmt::format("{} of {}, interrupted", ticks, wantedTicks)
                                        : fmt::format("{}", ticks));
  if (frames > 0) printRow("frames", fmt::format("{}", frames));
  if (const auto tick = spreadOf(times.milliseconds)) {
    printRow("a tick",
             fmt::format("{:.3f} ms median, {:.3f} to {:.3f} ms", tick->median, tick->min, tick->max));
  }
  if (const auto cpu = cpuMicroseconds(*this))
    printRow("CPU", fmt::format("{:.3f} us an agent and tick", *cpu));
  for (const StageTime& stage : times.stages) {
    printRow("", fmt::format("{:<10}{:9.4f} ms a tick", stage.stage,
                             stage.milliseconds / static_cast<double>(std::max<uint64_t>(ticks, 1))));
  }
  printRow("feet", fmt::format("slip {:.3f} % of leg length a stance, penetration {:.3f} %, float {:.3f} %",
                               100 * fidelity.slip, 100 * fidelity.penetration, 100 * fidelity.floating));
  printRow("reach error",
           fmt::format("{:.4f} % of leg length (99th percentile)", 100 * fidelity.reachErrorP99));
  printRow("limits", fmt::format("exceeded by at most {:.6f} rad", fidelity.limitViolation));
  if (fidelity.lastResorts > 0)
    printRow("no foothold", fmt::format("{} steps, a last resort", fidelity.lastResorts));
  if (fidelity.notFinite > 0) printRow("not finite", fmt::format("{} foot targets", fidelity.notFinite));
  printRow("state hash", fmt::format("{:016x}", stateHash));
  for (const std::string& file : files) printRow("written", file);
}

nlohmann::ordered_json Summary::json() const {
  const auto orNull = [](const auto& value) { return value ? nlohmann::ordered_json(*value) : nullptr; };
  const auto tick = spreadOf(times.milliseconds);
  nlohmann::ordered_json milliseconds = {{"min", nullptr}, {"median", nullptr}, {"max", nullptr}};
  if (tick) milliseconds = {{"min", tick->min}, {"median", tick->median}, {"max", tick->max}};
  return {{"device", device},
          {"agents", agents},
          {"ticks", ticks},
          {"seed", seed},
          {"tickMilliseconds", milliseconds},
          {"cpuMicrosecondsPerAgentTick", orNull(cpuMicroseconds(*this))},
          {"fidelity",
           {{"slip", fidelity.slip},
            {"penetration", fidelity.penetration},
            {"float", fidelity.floating},
            {"reachErrorP99", fidelity.reachErrorP99},
            {"limitViolation", fidelity.limitViolation}}},
          {"stateHash", fmt::format("{:016x}", stateHash)}};
}

}  // namespace skitter::app

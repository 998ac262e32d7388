#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench/crowd/contest.h"
#include "bench/crowd/peaks.h"
#include "bench/ik/machine.h"
#include "commands.h"
#include "crowd/stage.h"
#include "part_file.h"
#include "progress.h"
#include "scene_options.h"
#include "signals.h"
#include "skitter/error.h"
#include "values.h"

namespace skitter::app {
namespace {

using nlohmann::ordered_json;
using namespace bench;

constexpr double mostAgents = 16777216;  // as --agents of run
constexpr uint64_t mostRounds = 1000, progressParts = 1000;
constexpr uint32_t quickRounds = 3, quickWarmUp = 20;
constexpr double quickTurn = 0.05;

struct BenchOptions {
  SceneOptions scene;
  std::vector<double> agents = {1000, 10000, 100000};
  std::vector<std::string> controllers = {"adaptive", "clip"};
  std::optional<uint64_t> rounds;
  std::string json;
  bool poses = false, quick = false, quiet = false;
};

// Figures of a slow build, or of a driver that is watched, are figures of nothing.
void refuseSlowness() {
#if defined(SKITTER_DEBUG_BUILD)
  throw inputError("bench: this is a debug build, or one with sanitizers; configure with --preset release");
#endif
  for (const char* name : {"VK_INSTANCE_LAYERS", "VK_LOADER_LAYERS_ENABLE"}) {
    const char* layers = std::getenv(name);
    if (layers != nullptr && std::string(layers).find("validation") != std::string::npos)
      throw inputError(fmt::format("bench: {} turns the validation layer on; unset it", name));
  }
}

std::vector<std::string> devicesOf(const BenchOptions& options) {
  if (options.scene.device != "all") return {options.scene.device.value_or("")};
  std::vector<std::string> names;
  for (const DeviceReport& report : listDevices())
    if (report.suitable) names.push_back(fmt::format("{}", report.index));
  return names;
}

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

void printResults(const Match& match, bool cpu) {
  const auto agents = static_cast<double>(match.agents);
  fmt::print("{:<22}{:>10}  {:<24}{:>8}{:>18}{:>8}\n", "", "ms a tick", "(quartiles)", "CPU ms",
             "core-us an agent", "speed");
  const double device = costOf(match.results.front(), cpu);
  for (const Result& result : match.results) {
    const std::string range = fmt::format("({:.3f} to {:.3f})", result.wall.low, result.wall.high);
    fmt::print("{:<22}{:>10.3f}  {:<24}{:>8.3f}{:>18.4f}{:>8.2f}{}\n", result.name, result.wall.median, range,
               result.cpu.median, agents > 0 ? 1e3 * result.cpu.median / agents : 0,
               device / costOf(result, cpu), result.pass ? "" : "  WRONG");
  }
}

// The clocks of stages give shares; how long the whole takes is CPU time where `cpu`, else the wall's, so
// that who else is at work on the machine does not count.
double millisecondsOf(const StageTime& stage, const Result& result, bool cpu) {
  const double sum = std::max(sumOf(result.stages), 1e-9);
  return std::max(stage.milliseconds / sum * (cpu ? result.cpu.median : sum), 1e-9);
}

// A row a stage of the device, beside what the same stage takes its opponents.
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

ordered_json jsonOf(const Spread& spread) {
  return {{"median", spread.median}, {"low", spread.low}, {"high", spread.high}};
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
          {"wallMilliseconds", jsonOf(result.wall)},
          {"cpuMilliseconds", jsonOf(result.cpu)},
          {"stages", stages},
          {"checks", checks}};
}

ordered_json jsonOf(const std::string& controller, const Match& match) {
  ordered_json results = ordered_json::array(), demands = ordered_json::array();
  for (const Result& result : match.results) results.push_back(jsonOf(result));
  for (const StageDemand& demand : match.demands)
    demands.push_back({{"stage", demand.stage}, {"bytes", demand.bytes}, {"operations", demand.operations}});
  return {{"controller", controller},         {"agents", match.agents}, {"ticksATurn", match.ticks},
          {"memoryBytes", match.memoryBytes}, {"results", results},     {"demands", demands}};
}

// What is wrong with the results, empty if nothing.
std::string faultsOf(const Match& match) {
  std::string faults;
  for (const Result& result : match.results)
    for (const validation::StageResult& check : result.checks)
      if (!check.pass)
        faults +=
            fmt::format("{}{}, {}: {}", faults.empty() ? "" : "; ", result.name, check.name, check.worst);
  return faults;
}

ContestOptions contestOf(const BenchOptions& options, const std::string& controller) {
  ContestOptions contest;
  contest.crowd.measure = false;  // to judge is no part of animating
  contest.crowd.timestamps = true;
  contest.crowd.pose = options.poses || controller == "clip" || controller == "planted";
  contest.dt = options.scene.dt;
  if (options.quick) {
    contest.warmUp = quickWarmUp;
    contest.rounds = quickRounds;
    contest.turnSeconds = quickTurn;
  }
  if (options.rounds) contest.rounds = static_cast<uint32_t>(*options.rounds);
  return contest;
}

ordered_json benchDevice(const BenchOptions& options, const std::string& name) {
  DeviceRequest request;
  if (!name.empty()) request.device = name;
  Device device = Device::create(request);
  const bool cpu = isCpu(device.report());
  const Peaks peaks = [&] {
    const StopDeadline deadline;
    return measurePeaks(device.context());
  }();
  fmt::print(
      "{}copy          {:.1f} GB/s read and written\narithmetic    {:.1f} billion operations a second\n",
      machineLines(device.report()), 1e-9 * peaks.bytesPerSecond, 1e-9 * peaks.operationsPerSecond);
  ordered_json matches = ordered_json::array();
  for (const std::string& controller : options.controllers)
    for (const double agents : options.agents) {
      SceneOptions chosen = options.scene;
      chosen.controller = controller;
      chosen.agents = static_cast<uint64_t>(agents);
      const Scene scene = chosen.load();
      ContestOptions contestOptions = contestOf(options, controller);
      contestOptions.seed = scene.seed;
      Match match;
      {
        Progress progress(fmt::format("{}, {} agents, thousandths", controller, chosen.agents.value()),
                          progressParts, options.quiet);
        const StopDeadline deadline;
        match = contest(
            device, scene.loadTerrain(), scene, contestOptions,
            [&](double share) { progress.update(static_cast<uint64_t>(share * progressParts)); },
            [] { return stopRequested(); });
      }
      if (stopRequested()) throw Error(Error::Kind::check, "interrupted; nothing is written");
      fmt::print("\n{}, {} agents{}, {} rounds of {} ticks, {:.0f} MiB of records; speed by {}\n", controller,
                 match.agents, contestOptions.crowd.pose ? " with poses" : "", contestOptions.rounds,
                 match.ticks, static_cast<double>(match.memoryBytes) / (1 << 20),
                 cpu ? "CPU time" : "the wall clock");
      printResults(match, cpu);
      printStages(match, peaks, cpu);
      if (const std::string faults = faultsOf(match); !faults.empty())
        throw Error(Error::Kind::check,
                    fmt::format("{}, {} agents: results are wrong: {}", controller, match.agents, faults));
      matches.push_back(jsonOf(controller, match));
    }
  ordered_json made = describeMachine(device.report());
  made["copyBytesPerSecond"] = peaks.bytesPerSecond;
  made["operationsPerSecond"] = peaks.operationsPerSecond;
  made["matches"] = matches;
  return made;
}

int bench(const BenchOptions& options) {
  refuseSlowness();
  if (!options.json.empty()) checkFileTarget("--json", options.json);
  ordered_json devices = ordered_json::array();
  for (const std::string& name : devicesOf(options)) devices.push_back(benchDevice(options, name));
  if (!options.json.empty()) writeText(options.json, ordered_json{{"devices", devices}}.dump(1) + "\n");
  return 0;
}

}  // namespace

void addBench(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* command = app.add_subcommand(
      "bench", "Time a scene's tick on the device and on the CPU, turn by turn in one run, and check both");
  options->scene.addTo(*command, nullptr);
  command
      ->add_option_function<std::string>(
          "--agents",
          [options](const std::string& text) {
            options->agents = parseNumbers("--agents", text, 1, mostAgents);
            for (const double count : options->agents)
              if (count != std::floor(count))
                throw inputError(fmt::format("--agents is {}, expected whole numbers N,N,..", text));
          },
          "how many agents, one match each [1000,10000,100000]")
      ->type_name("N,N,..");
  command->add_option("--controllers", options->controllers, "of every herd, one match each [adaptive,clip]")
      ->delimiter(',')
      ->type_name("NAME,NAME,..");
  command
      ->add_option_function<std::string>(
          "--rounds",
          [options](const std::string& text) {
            options->rounds = parseWhole("--rounds", text, 1, mostRounds);
          },
          "turns of each contestant [7]")
      ->type_name("N");
  command->add_flag("--poses", options->poses, "bone poses for everybody; those of clips are always made");
  command->add_flag("--quick", options->quick, "3 short rounds");
  command->add_option("--json", options->json, "write all figures to a file, for scripts/plots")
      ->type_name("FILE");
  command->add_flag("--quiet", options->quiet, "no progress on stderr");
  command->footer(
      "--device all times every suitable device. Each match checks a tick of every contestant against the "
      "reference;\n"
      "figures of wrong results, of debug builds and under the validation layer are refused. "
      "docs/performance.md tells what is\n"
      "measured and how.\n"
      "\n"
      "Examples:\n"
      "  skitter bench --quick\n"
      "  skitter bench --agents 1000,10000,100000,1000000 --controllers adaptive --json bench.json");
  command->callback([options, &chosen] { chosen = [options] { return bench(*options); }; });
}

}  // namespace skitter::app

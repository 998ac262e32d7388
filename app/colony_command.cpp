#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/colony/threat_map.h"
#include "app/commands.h"
#include "app/common/files.h"
#include "app/common/manifest.h"
#include "app/common/progress.h"
#include "app/common/signals.h"
#include "app/common/values.h"
#include "base/clock.h"
#include "cpu_reference/ways/colony.h"
#include "skitter/colony.h"
#include "skitter/error.h"

namespace skitter::app {
namespace {

constexpr uint64_t mostRuns = 100000, leastSide = 16, mostSide = 512, mostColonyIterations = 100000;
// A path this little longer than the shortest counts as it.
constexpr double asShort = 1.0005;

struct ColonyOptions {
  uint64_t seeds = 100;
  std::optional<uint64_t> map;
  uint32_t side = 128;
  uint32_t iterations = 100;
  Colony::Options colony;
  std::optional<std::string> device;
  std::optional<std::pair<double, double>> failAbove;  // per cent: of the median, and of the worst
  std::string json;
  bool quiet = false;
};

// A colony's search, beside what Dijkstra's algorithm finds on the same graph.
struct ColonyRun {
  uint64_t map = 0, seed = 0;
  std::optional<uint64_t> shortest = {},
                          length = {};  // 1/512 of a cell of flat ground; none: there is no way
  uint32_t iteration = 0;               // that found the path
  double makeMilliseconds = 0, searchMilliseconds = 0;

  // None where no way leads to the goal. Infinite where one does that no scout has found.
  std::optional<double> ratio() const {
    if (!shortest) return {};
    if (!length) return std::numeric_limits<double>::infinity();
    return static_cast<double>(*length) / static_cast<double>(*shortest);
  }
};

// Run n has map n or, where all have one map, scouts of seed n.
ColonyRun runOf(Device& device, const ColonyOptions& options, uint64_t number) {
  ColonyRun run{.map = options.map.value_or(number), .seed = options.map ? number : options.colony.seed};
  const ThreatMap map = threatMap(options.side, run.map);
  const auto indexOf = [&](const glm::uvec2& cell) { return cell.y * map.grid.columns + cell.x; };
  const reference::Colony graph({map.grid.columns, map.grid.rows, map.grid.cost}, {}, indexOf(map.nest),
                                indexOf(map.goal));
  if (const uint64_t shortest = graph.shortest(); shortest != UINT64_MAX) run.shortest = shortest;
  Colony::Options chosen = options.colony;
  chosen.seed = run.seed;
  std::optional<Colony> colony;
  run.makeMilliseconds =
      1e3 * base::timed([&] { colony.emplace(device, map.grid, map.nest, map.goal, chosen); }).wall;
  run.searchMilliseconds = 1e3 * base::timed([&] { colony->search(options.iterations); }).wall;
  if (const std::optional<ColonyPath> best = colony->best()) {
    run.length = best->fixedLength;
    run.iteration = best->iteration;
  }
  return run;
}

struct ColonySpread {
  double least = 0, median = 0, most = 0;
};
std::optional<ColonySpread> colonySpreadOf(std::vector<double> values) {
  if (values.empty()) return {};
  std::ranges::sort(values);
  const size_t n = values.size();
  return ColonySpread{values.front(), 0.5 * (values[(n - 1) / 2] + values[n / 2]), values.back()};
}

// A number that JSON has; null for none and for infinity.
nlohmann::ordered_json numberOrNull(const std::optional<double>& value) {
  if (!value || !std::isfinite(*value)) return nullptr;
  return *value;
}
nlohmann::ordered_json jsonOf(const std::optional<ColonySpread>& spread) {
  if (!spread) return {{"min", nullptr}, {"median", nullptr}, {"max", nullptr}};
  return {{"min", numberOrNull(spread->least)},
          {"median", numberOrNull(spread->median)},
          {"max", numberOrNull(spread->most)}};
}

// The runs so far, printed for people and written for programs.
class ColonyReport {
 public:
  ColonyReport(const ColonyOptions& options, std::string device)
      : options_(options), device_(std::move(device)) {}

  uint64_t count() const { return runs_.size(); }
  void add(const ColonyRun& run) { runs_.push_back(run); }

  void write(const Manifest& manifest) const {
    if (options_.json.empty()) return;
    nlohmann::ordered_json each = nlohmann::ordered_json::array();
    for (const ColonyRun& run : runs_) {
      nlohmann::ordered_json shortest = nullptr, length = nullptr;
      if (run.shortest) shortest = *run.shortest;
      if (run.length) length = *run.length;
      each.push_back({{"map", run.map},
                      {"seed", run.seed},
                      {"shortest", shortest},
                      {"length", length},
                      {"ratio", numberOrNull(run.ratio())},
                      {"iteration", run.iteration},
                      {"makeMilliseconds", run.makeMilliseconds},
                      {"searchMilliseconds", run.searchMilliseconds}});
    }
    writeJson(options_.json,
              {{"device", device_},
               {"rule", nameOf(options_.colony.rule)},
               {"ants", options_.colony.ants},
               {"iterations", options_.iterations},
               {"side", options_.side},
               {"runs", count()},
               {"runsWanted", options_.seeds},
               {"interrupted", count() < options_.seeds},
               {"withoutWay", withoutWay()},
               {"notArrived", notArrived()},
               {"ratio", jsonOf(colonySpreadOf(ratios()))},
               {"asShort", numberAsShort()},
               {"makeMilliseconds", jsonOf(spreadOf(&ColonyRun::makeMilliseconds))},
               {"searchMilliseconds", jsonOf(spreadOf(&ColonyRun::searchMilliseconds))},
               {"each", each}},
              manifest);
  }

  void print() const {
    const auto row = [](const char* name, const std::string& text) { fmt::print("{:<12}{}\n", name, text); };
    row("device", device_);
    row("maps", options_.map ? fmt::format("map {}, seeds 1 to {}", *options_.map, count())
                             : fmt::format("maps 1 to {}, seed {}", count(), options_.colony.seed));
    row("grid", fmt::format("{0} x {0} cells, twelve threats, ten walls", options_.side));
    row("colony", fmt::format("{}, {} ants, {} iterations", nameOf(options_.colony.rule),
                              options_.colony.ants, options_.iterations));
    if (const auto ratio = colonySpreadOf(ratios()))
      row("length",
          fmt::format("median {:.4f}, worst {:.4f} of the shortest path; {} of {} within {:.2g} %",
                      ratio->median, ratio->most, numberAsShort(), ratios().size(), 100 * (asShort - 1)));
    if (notArrived() > 0) row("not found", fmt::format("{} paths", notArrived()));
    if (withoutWay() > 0) row("no way", fmt::format("on {} maps, which do not count", withoutWay()));
    const auto search = spreadOf(&ColonyRun::searchMilliseconds),
               make = spreadOf(&ColonyRun::makeMilliseconds);
    if (search && make)
      row("a run",
          fmt::format("{:.1f} ms median, {:.1f} to {:.1f} ms; {:.1f} ms before it to make the colony",
                      search->median, search->least, search->most, make->median));
    if (!options_.json.empty()) row("written", options_.json);
  }

  // Throws Error(check) where paths are longer than was asked for.
  void judge() const {
    const auto ratio = colonySpreadOf(ratios());
    if (!options_.failAbove || !ratio) return;
    const auto [median, worst] = *options_.failAbove;
    const double medianMore = 100 * (ratio->median - 1), worstMore = 100 * (ratio->most - 1);
    if (medianMore > median || worstMore > worst)
      throw Error(
          Error::Kind::check,
          fmt::format("paths are {:.2f} % longer than the shortest in the median and {:.2f} % at worst, "
                      "expected at most {:g} and {:g} %",
                      medianMore, worstMore, median, worst));
  }

 private:
  std::vector<double> ratios() const {
    std::vector<double> all;
    for (const ColonyRun& run : runs_)
      if (const auto ratio = run.ratio()) all.push_back(*ratio);
    return all;
  }
  std::optional<ColonySpread> spreadOf(double ColonyRun::*member) const {
    std::vector<double> all;
    for (const ColonyRun& run : runs_) all.push_back(run.*member);
    return colonySpreadOf(std::move(all));
  }
  auto numberOf(const auto& predicate) const {
    return static_cast<uint64_t>(std::ranges::count_if(runs_, predicate));
  }
  uint64_t withoutWay() const {
    return numberOf([](const ColonyRun& run) { return !run.shortest; });
  }
  uint64_t notArrived() const {
    return numberOf([](const ColonyRun& run) { return run.shortest && !run.length; });
  }
  uint64_t numberAsShort() const {
    return numberOf([](const ColonyRun& run) { return run.ratio() && *run.ratio() <= asShort; });
  }

  const ColonyOptions& options_;
  std::string device_;
  std::vector<ColonyRun> runs_;
};

int searchByColonies(const ColonyOptions& options) {
  Files files;
  files.writes("--json", options.json);
  files.check();
  std::optional<StopDeadline> opening(std::in_place);
  Device device = Device::create({.device = options.device});
  opening.reset();
  Manifest manifest{.seed = options.map ? std::nullopt : std::optional(options.colony.seed)};
  manifest.add(device.report());
  ColonyReport report(options, device.report().name);
  const auto leave = [&] {
    report.write(manifest);
    return interruptedAfter(report.count(), options.seeds, "runs");
  };
  {
    Progress progress("runs", options.seeds, options.quiet);
    while (report.count() < options.seeds && !stopRequested()) {
      ColonyRun run;
      {
        const StopDeadline deadline(std::ref(leave));
        run = runOf(device, options, report.count() + 1);
      }
      report.add(run);
      progress.update(report.count());
    }
  }
  report.write(manifest);
  report.print();
  if (report.count() < options.seeds)
    throw Interrupted(interruptedAfter(report.count(), options.seeds, "runs"));
  report.judge();
  return 0;
}

void addWholeTo(CLI::App& command, const char* name, uint64_t least, uint64_t most, const std::string& help,
                std::function<void(uint64_t)> set) {
  command
      .add_option_function<std::string>(
          name,
          [name, least, most, set = std::move(set)](const std::string& text) {
            set(parseWhole(name, text, least, most));
          },
          help)
      ->type_name("N");
}

}  // namespace

void addColony(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<ColonyOptions>();
  CLI::App* command = app.add_subcommand(
      "colony", "Let colonies of scouts search for paths through threats, and judge how short these are");
  addWholeTo(*command, "--seeds", 1, mostRuns,
             "runs: of maps 1, 2, ... or, with --map, of seeds 1, 2, ... [100]",
             [options](uint64_t n) { options->seeds = n; });
  addWholeTo(*command, "--map", 0, UINT64_MAX, "one map for all runs [one for each]",
             [options](uint64_t n) { options->map = n; });
  addWholeTo(*command, "--side", leastSide, mostSide, "cells a side of a map [128]",
             [options](uint64_t n) { options->side = static_cast<uint32_t>(n); });
  addWholeTo(*command, "--iterations", 1, mostColonyIterations, "of a run [100]",
             [options](uint64_t n) { options->iterations = static_cast<uint32_t>(n); });
  addWholeTo(*command, "--ants", 1, Colony::maxAnts, "scouts of a colony [64]",
             [options](uint64_t n) { options->colony.ants = static_cast<uint32_t>(n); });
  addWholeTo(*command, "--passes", 0, Colony::maxSteps, "of tightening, at most [32]",
             [options](uint64_t n) { options->colony.passes = static_cast<uint32_t>(n); });
  command
      ->add_option_function<std::string>(
          "--rule",
          [options](const std::string& text) {
            options->colony.rule = parseNamed("--rule", text, allColonyRules);
          },
          fmt::format("{} (docs/colony.md) [mmas]", namesOf(allColonyRules)))
      ->type_name("NAME");
  command
      ->add_option_function<std::string>(
          "--least",
          [options](const std::string& text) {
            options->colony.least = static_cast<float>(parseNumber("--least", text, 0x1p-16, 1 - 0x1p-20));
          },
          "tau_min of mmas, tau_0 of acs, as a share of the most pheromone [0.002]")
      ->type_name("T");
  command
      ->add_option_function<std::string>(
          "--fail-above",
          [options](const std::string& text) {
            options->failAbove = parsePair("--fail-above", text, 0, 1e6, true);
          },
          "exit code 1 where paths are longer than the shortest by more per cent: in the median, and at "
          "worst")
      ->type_name("MEDIAN[,WORST]");
  command
      ->add_option_function<std::string>(
          "--device", [options](const std::string& text) { options->device = text; },
          "number or part of the name of the device (skitter info) [the best suitable]")
      ->type_name("NAME|INDEX");
  command->add_option("--json", options->json, "write the figures to a file")->type_name("FILE");
  command->add_flag("--quiet", options->quiet, "no progress on stderr");
  command->footer(
      "A map has twelve threats and ten walls between its nest and its goal. The shortest path is that of "
      "Dijkstra's\n"
      "algorithm on the same graph. docs/colony.md says how colonies search and how good their paths are.\n"
      "\n"
      "Examples:\n"
      "  skitter colony --json colony.json\n"
      "  skitter colony --map 3 --seeds 36\n"
      "  skitter colony --fail-above 3,10");
  command->callback([options, &chosen] { chosen = [options] { return searchByColonies(*options); }; });
}

}  // namespace skitter::app

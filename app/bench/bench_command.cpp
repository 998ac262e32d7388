#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "app/bench/avoid_report.h"
#include "app/bench/baseline.h"
#include "app/bench/frame_times.h"
#include "app/bench/match_report.h"
#include "app/commands.h"
#include "app/common/drawing_options.h"
#include "app/common/files.h"
#include "app/common/manifest.h"
#include "app/common/progress.h"
#include "app/common/scene_options.h"
#include "app/common/signals.h"
#include "app/common/values.h"
#include "bench/crowd/avoid_contest.h"
#include "bench/crowd/contest.h"
#include "bench/crowd/peaks.h"
#include "bench/ik/machine.h"
#include "crowd/controller.h"
#include "crowd/stage.h"
#include "skitter/error.h"

namespace skitter::app {
namespace {

using nlohmann::ordered_json;
using namespace bench;

constexpr uint64_t mostRounds = 1000;
constexpr uint32_t quickRounds = 3, quickWarmUp = 20;
constexpr double quickTurn = 0.05;
constexpr uint32_t quickFrames = 10, quickWarmUpFrames = 3, quickTimedFrames = 3;
constexpr double usualFailAbove = 10, mostFailAbove = 1e6;  // per cent

struct BenchOptions {
  SceneOptions scene;
  std::optional<std::vector<double>> agents;
  std::vector<Controller> controllers = {Controller::adaptive, Controller::clip};
  std::optional<uint64_t> rounds;
  std::string json, baseline, levels;
  std::optional<double> failAbove;  // per cent
  FrameOptions frames;
  bool avoid = false, poses = false, quick = false, quiet = false, draw = false;

  std::vector<double> counts() const {
    if (agents) return *agents;
    if (draw) return {0, 1000, 10000, 100000};
    if (avoid) return {10000, 100000, 1000000};
    return {1000, 10000, 100000};
  }
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

ContestOptions contestOf(const BenchOptions& options, Controller controller) {
  ContestOptions contest;
  contest.crowd.measure = false;  // to judge is no part of animating
  contest.crowd.timestamps = true;
  contest.crowd.pose = options.poses || crowd::traitsOf(controller).playsClips;
  contest.dt = options.scene.dt;
  if (options.quick) {
    contest.warmUp = quickWarmUp;
    contest.rounds = quickRounds;
    contest.turnSeconds = quickTurn;
  }
  if (options.rounds) contest.rounds = static_cast<uint32_t>(*options.rounds);
  return contest;
}

// The measurements so far.
struct Record {
  Manifest manifest;
  ordered_json devices = ordered_json::array(), draw = ordered_json::array();
  uint64_t matches = 0, wanted = 0;
  std::optional<Baseline> baseline = {};
  uint64_t compared = 0;    // matches that the baseline has
  std::string slower = {};  // those that take too much longer than there
};

void write(const BenchOptions& options, const Record& record) {
  if (options.json.empty()) return;
  ordered_json json = {{"devices", record.devices},
                       {"matches", record.matches},
                       {"matchesWanted", record.wanted},
                       {"interrupted", record.matches < record.wanted}};
  if (options.draw)
    json = {{"devices", record.devices},
            {"picture",
             {{"width", options.frames.size.width},
              {"height", options.frames.size.height},
              {"renderScale", std::round(1e6 * double{options.frames.drawing.scale}) / 1e6},
              {"levels", options.levels.empty() ? ordered_json() : ordered_json(options.levels)},
              {"occlusion", options.frames.drawing.occlusion ? ordered_json(*options.frames.drawing.occlusion)
                                                             : ordered_json()}}},
            {"draw", record.draw},
            {"drawsWanted", record.wanted},
            {"interrupted", record.draw.size() < record.wanted}};
  writeJson(options.json, json, record.manifest);
}

// Holds a match against the same one of the baseline.
void compare(const BenchOptions& options, const DeviceReport& device, Controller controller,
             const Match& match, ordered_json& made, Record& record) {
  if (!record.baseline) return;
  const auto slowdown =
      record.baseline->slowdown(device.name, controller, made.at("poses"), match, isCpu(device));
  if (!slowdown) {
    fmt::print("baseline      has no such match of this device\n");
    return;
  }
  ++record.compared;
  const double limit = options.failAbove.value_or(usualFailAbove);
  const double median = 100 * slowdown->median, low = 100 * slowdown->low;
  fmt::print("baseline      {:+.1f} % of time (lower quartile {:+.1f} %), at most +{:g} %\n", median, low,
             limit);
  made["slowdownPercent"] = {{"median", median}, {"low", low}};
  if (low > limit)
    record.slower += fmt::format("{}{}, {} agents: {:+.1f} %", record.slower.empty() ? "" : "; ",
                                 nameOf(controller), match.agents, median);
}

// Grid and avoid of crowds that differ in nothing but the number of agents.
void benchAvoid(const BenchOptions& options, Device& device, ordered_json& made, Record& record,
                const StopDeadline::Leave& leave) {
  const bool cpu = isCpu(device.report());
  const Scene scene = options.scene.load();
  ContestOptions contest = contestOf(options, Controller::adaptive);
  contest.seed = scene.seed;
  made["avoidMatches"] = ordered_json::array();
  std::vector<AvoidMatch> matches;
  for (const double agents : options.counts()) {
    const AvoidCrowd crowd = avoidCrowdOf(scene, static_cast<uint32_t>(agents));
    AvoidMatch match;
    {
      Progress progress(fmt::format("grid and avoid, {} agents", agents), options.quiet);
      const StopDeadline deadline(leave);
      match = avoidContest(
          device, crowd, contest, [&](double share) { progress.updateShare(share); },
          [] { return stopRequested(); });
    }
    if (stopRequested()) throw Interrupted(leave());
    print(match, contest.rounds, cpu);
    if (const std::string faults = faultsOf(match.results); !faults.empty())
      throw Error(Error::Kind::check,
                  fmt::format("grid and avoid, {} agents: results are wrong: {}", match.agents, faults));
    made["avoidMatches"].push_back(jsonOf(match));
    matches.push_back(std::move(match));
    ++record.matches;
  }
  const std::vector<Growth> growth = growthOf(matches, cpu);
  print(growth);
  made["growth"] = jsonOf(growth);
}

void benchDevice(const BenchOptions& options, const Heightfield& terrain, const std::string& name,
                 Record& record) {
  const auto leave = [&] {
    write(options, record);
    return interruptedAfter(record.matches, record.wanted, "matches");
  };
  std::optional<StopDeadline> opening(leave);
  DeviceRequest request;
  if (!name.empty()) request.device = name;
  Device device = Device::create(request);
  const bool cpu = isCpu(device.report());
  const Peaks peaks = measurePeaks(device.context());
  opening.reset();
  record.manifest.add(device.report());
  fmt::print(
      "{}copy          {:.1f} GB/s read and written\narithmetic    {:.1f} billion operations a second\n",
      machineLines(device.report(), opponentBuild()), 1e-9 * peaks.bytesPerSecond,
      1e-9 * peaks.operationsPerSecond);
  ordered_json& made = record.devices.emplace_back(describeMachine(device.report()));
  made["cpuOpponentBuild"] = opponentBuild();
  made["copyBytesPerSecond"] = peaks.bytesPerSecond;
  made["operationsPerSecond"] = peaks.operationsPerSecond;
  made["matches"] = ordered_json::array();
  if (options.avoid) return benchAvoid(options, device, made, record, leave);
  for (const Controller controller : options.controllers)
    for (const double agents : options.counts()) {
      SceneOptions chosen = options.scene;
      chosen.controller = controller;
      chosen.agents = static_cast<uint64_t>(agents);
      const Scene scene = chosen.load();
      ContestOptions contestOptions = contestOf(options, controller);
      contestOptions.seed = scene.seed;
      Match match;
      {
        Progress progress(fmt::format("{}, {} agents", nameOf(controller), chosen.agents.value()),
                          options.quiet);
        const StopDeadline deadline(leave);
        match = contest(
            device, terrain, scene, contestOptions, [&](double share) { progress.updateShare(share); },
            [] { return stopRequested(); });
      }
      if (stopRequested()) throw Interrupted(leave());
      fmt::print("\n{}, {} agents{}, {} rounds, {:.0f} MiB of records; speed by {}\n", nameOf(controller),
                 match.agents, contestOptions.crowd.pose ? " with poses" : "", contestOptions.rounds,
                 static_cast<double>(match.memoryBytes) / (1 << 20), cpu ? "CPU time" : "the wall clock");
      printResults(match.agents, match.results, cpu);
      printStages(match, peaks, cpu);
      if (const std::string faults = faultsOf(match.results); !faults.empty())
        throw Error(Error::Kind::check, fmt::format("{}, {} agents: results are wrong: {}",
                                                    nameOf(controller), match.agents, faults));
      ordered_json& row = made["matches"].emplace_back(jsonOf(controller, match));
      row["poses"] = contestOptions.crowd.pose;
      compare(options, device.report(), controller, match, row, record);
      ++record.matches;
    }
}

FrameOptions framesOf(const BenchOptions& options) {
  FrameOptions frames = options.frames;
  frames.dt = options.scene.dt;
  if (!options.levels.empty()) frames.levels = loadLevels(options.levels);
  if (options.quick) {
    frames.warmUp = quickWarmUpFrames;
    frames.frames = quickFrames;
    frames.timedFrames = quickTimedFrames;
  }
  return frames;
}

void drawOn(const BenchOptions& options, const Heightfield& terrain, const std::string& name,
            Record& record) {
  const auto leave = [&] {
    write(options, record);
    return interruptedAfter(record.draw.size(), record.wanted, "scenes");
  };
  std::optional<StopDeadline> opening(leave);
  DeviceRequest request;
  if (!name.empty()) request.device = name;
  Device device = Device::create(request);
  opening.reset();
  record.manifest.add(device.report());
  record.devices.push_back(describeMachine(device.report()));
  const FrameOptions frames = framesOf(options);
  fmt::print("device        {} ({})\npictures      {} x {} pixels{}, {} after {}\n", device.report().name,
             device.report().typeName(), frames.size.width, frames.size.height,
             frames.drawing.scale < 1 ? fmt::format(", render scale {}", frames.drawing.scale) : "",
             frames.frames, frames.warmUp);
  for (const double agents : options.counts()) {
    SceneOptions chosen = options.scene;
    chosen.agents = static_cast<uint64_t>(agents);
    const Scene scene = chosen.load();
    FrameTimes times;
    {
      Progress progress(fmt::format("{} agents", chosen.agents.value()), options.quiet);
      const StopDeadline deadline(leave);
      times = timeFrames(
          device, terrain, scene, frames, [&](double share) { progress.updateShare(share); },
          [] { return stopRequested(); });
    }
    if (stopRequested()) throw Interrupted(leave());
    print(times);
    ordered_json row = jsonOf(times);
    row["device"] = device.report().name;
    record.draw.push_back(row);
  }
}

// Its crowds are not the scene's.
void refuseBesideAvoid(const BenchOptions& options, const CLI::App& command) {
  const std::pair<const char*, bool> given[] = {{"a scene", !options.scene.scene.empty()},
                                                {"--terrain", !options.scene.terrain.empty()},
                                                {"--controllers", command.count("--controllers") > 0},
                                                {"--solver", options.scene.solver.has_value()},
                                                {"--stepping", options.scene.stepping.has_value()},
                                                {"--baseline", !options.baseline.empty()},
                                                {"--poses", options.poses}};
  for (const auto& [what, isGiven] : given)
    if (isGiven)
      throw inputError(
          fmt::format("bench: --avoid and {} are given, expected one of them: --avoid times a "
                      "crowd of its own, without whole ticks",
                      what));
}

// Each option that means nothing beside the others. Throws Error(input).
void refuseWhatMeansNothing(const BenchOptions& options, const CLI::App& command) {
  for (const char* option : {"--size", renderScaleOption, occlusionOption, "--levels"})
    if (!options.draw && command.count(option) > 0)
      throw inputError(fmt::format("{} is of pictures, expected --draw beside it", option));
  for (const char* option : {"--avoid", "--controllers", "--rounds", "--poses", "--baseline", "--fail-above"})
    if (options.draw && command.count(option) > 0)
      throw inputError(fmt::format("{} is of matches, expected none beside --draw", option));
  if (options.avoid) refuseBesideAvoid(options, command);
  for (const double agents : options.counts())
    if (!options.draw && agents < 1)
      throw inputError(fmt::format("--agents is {:g}, expected at least 1 without --draw", agents));
}

int draw(const BenchOptions& options, const Scene& scene) {
  const Heightfield terrain = scene.loadTerrain();
  const std::vector<std::string> names = options.scene.devices();
  Record record{.manifest = {.scene = &scene, .terrain = &terrain, .dt = options.scene.dt}};
  record.wanted = names.size() * options.counts().size();
  for (const std::string& name : names) drawOn(options, terrain, name, record);
  write(options, record);
  return 0;
}

int bench(const BenchOptions& options) {
  refuseSlowness();
  Files files;
  const Scene scene = options.scene.load();
  options.scene.declare(files, scene);
  files.reads("--baseline", options.baseline);
  if (options.levels != "default") files.reads("--levels", options.levels);
  files.writes("--json", options.json);
  files.check();
  if (options.draw) return draw(options, scene);
  for (size_t h = 0; h < scene.herds.size(); ++h)
    if (scene.herds[h].avoid)
      throw inputError(
          fmt::format("bench: herds[{}].avoid of {} is true, expected false: whole ticks are timed "
                      "without it; --avoid times it by itself",
                      h, scene.name));
  for (size_t h = 0; h < scene.herds.size(); ++h)
    if (scene.herds[h].forage)
      throw inputError(fmt::format(
          "bench: herds[{}] of {} forages, expected none: the opponents have no trails", h, scene.name));
  for (size_t h = 0; h < scene.herds.size(); ++h)
    if (scene.herds[h].ways)
      throw inputError(fmt::format(
          "bench: herds[{}] of {} has ways, expected none: the opponents go straight", h, scene.name));
  if (options.failAbove && options.baseline.empty())
    throw inputError("--fail-above needs --baseline FILE to compare with");
  const Heightfield terrain = scene.loadTerrain();
  const std::vector<std::string> names = options.scene.devices();
  Record record{.manifest = {.scene = &scene, .terrain = &terrain, .dt = options.scene.dt}};
  if (!options.baseline.empty()) record.baseline.emplace(options.baseline);
  record.wanted = names.size() * (options.avoid ? 1 : options.controllers.size()) * options.counts().size();
  for (const std::string& name : names) benchDevice(options, terrain, name, record);
  write(options, record);
  if (record.baseline && record.compared == 0)
    throw inputError(
        fmt::format("--baseline {}: has none of these matches: device, controller, agents and poses "
                    "must be the same",
                    options.baseline));
  if (!record.slower.empty())
    throw Error(Error::Kind::check, fmt::format("slower than {}: {}", options.baseline, record.slower));
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
            options->agents = parseNumbers("--agents", text, 0, Scene::maxAgents);
            for (const double count : *options->agents)
              if (count != std::floor(count))
                throw inputError(fmt::format("--agents is {}, expected whole numbers N,N,..", text));
          },
          "how many agents, one match or scene that is drawn each [1000,10000,100000; with --draw also 0; "
          "with "
          "--avoid 10000,100000,1000000]")
      ->type_name("N,N,..");
  command
      ->add_option_function<std::string>(
          "--controllers",
          [options](const std::string& text) {
            options->controllers = parseNames("--controllers", text, allControllers);
          },
          "of every herd, one match each [adaptive,clip]")
      ->type_name("NAME,NAME,..");
  command
      ->add_option_function<std::string>(
          "--rounds",
          [options](const std::string& text) {
            options->rounds = parseWhole("--rounds", text, 1, mostRounds);
          },
          "turns of each contestant [7]")
      ->type_name("N");
  command->add_flag(
      "--avoid", options->avoid,
      "instead of whole ticks: the grid of neighbours and stage avoid, of agents with ten others "
      "in reach, beside the same work and RVO2's algorithm on the CPU");
  command->add_flag("--poses", options->poses, "bone poses for everybody; those of clips are always made");
  command->add_flag("--draw", options->draw,
                    "time frames instead: a tick, its picture, and the picture's way to the host");
  command
      ->add_option_function<std::string>(
          "--size", [options](const std::string& text) { options->frames.size = parseSize("--size", text); },
          "of the pictures that --draw draws, in pixels [1280x720]")
      ->type_name("WxH");
  addDrawingOptions(*command, options->frames.drawing);
  command
      ->add_option("--levels", options->levels,
                   "with --draw: who is far from the camera ticks less often, as in skitter run [those of "
                   "the scene, else none]")
      ->type_name("default|FILE");
  command->add_flag("--quick", options->quick, "3 short rounds; with --draw 10 frames");
  command->add_option("--json", options->json, "write all figures to a file, for scripts/plots")
      ->type_name("FILE");
  command
      ->add_option("--baseline", options->baseline,
                   "figures of an earlier --json, to hold the same matches against")
      ->type_name("FILE");
  command
      ->add_option_function<std::string>(
          "--fail-above",
          [options](const std::string& text) {
            options->failAbove = parseNumber("--fail-above", text, 0, mostFailAbove);
          },
          fmt::format("exit code 1 where a tick takes so much longer than the baseline's median in three "
                      "quarters of the turns [{:g}]",
                      usualFailAbove))
      ->type_name("PERCENT");
  command->add_flag("--quiet", options->quiet, "no progress on stderr");
  command->footer(
      "--device all times every suitable device. Each match checks a timed tick of every contestant against "
      "the "
      "reference;\n"
      "figures of wrong results, of debug builds and under the validation layer are refused. "
      "docs/performance.md tells what is\n"
      "measured and how.\n"
      "\n"
      "Examples:\n"
      "  skitter bench --quick\n"
      "  skitter bench --agents 1000,10000,100000,1000000 --controllers adaptive --json bench.json\n"
      "  skitter bench --avoid --agents 10000,1000000\n"
      "  skitter bench --agents 10000 --baseline bench.json --fail-above 10\n"
      "  skitter bench --draw --json draw.json");
  command->callback([options, command, &chosen] {
    chosen = [options, command] {
      refuseWhatMeansNothing(*options, *command);
      return bench(*options);
    };
  });
}

}  // namespace skitter::app

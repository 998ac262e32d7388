#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/common/files.h"
#include "app/common/law_watch.h"
#include "app/common/manifest.h"
#include "app/common/progress.h"
#include "app/common/scene_options.h"
#include "app/common/signals.h"
#include "app/common/simulate.h"
#include "app/common/values.h"
#include "app/common/warnings.h"
#include "app/validate/ground_edits.h"
#include "app/validate/outcome.h"
#include "crowd/events.h"
#include "crowd/readback.h"
#include "gpu/submit.h"
#include "skitter/error.h"
#include "validation/free_run.h"
#include "validation/herd_facts.h"
#include "validation/lockstep/lockstep.h"

namespace skitter::app {
namespace {

using validation::Lockstep;

constexpr uint64_t defaultAgents = 64, defaultFrames = 120, mostFrames = 1000000;
constexpr double longestTimeout = 1e6;  // seconds

struct ValidateOptions {
  SceneOptions scene;
  uint64_t frames = defaultFrames;
  std::string json, junit, levels;
  std::vector<crowd::StageId> stages;  // that are compared; none: all
  std::optional<double> timeout;       // seconds
  bool apart = false, edits = false, freeRun = false, quiet = false, sleep = false, strict = false;
  uint32_t pageAgents = 0;  // 0: as many as the device allows
};

using States = std::map<crowd::RunKey, HerdState>;

// Everybody who is there.
States download(const Crowd& crowd) {
  States states;
  for (const crowd::HerdRun& of : crowd::allRuns(implOf(crowd)))
    states.emplace(of.key(), crowd::download(implOf(crowd), *of.run));
  return states;
}

// Beside the device's crowd: the same herds walked by the reference alone, from the same first state.
class FreeRuns {
 public:
  explicit FreeRuns(const Crowd& crowd) { follow(crowd, {}, download(crowd)); }

  // Takes over what has happened between two ticks, from the states before and after it. A herd that has come
  // begins as it is.
  void follow(const Crowd& crowd, const States& before, const States& after) {
    std::erase_if(runs_, [&](const auto& each) { return !after.contains(each.first); });
    for (const crowd::HerdRun& of : crowd::allRuns(implOf(crowd))) {
      const HerdState& now = after.at(of.key());
      if (const auto known = runs_.find(of.key()); known != runs_.end())
        known->second->follow(before.at(of.key()), now);
      else
        runs_.emplace(of.key(),
                      std::make_unique<validation::FreeRun>(validation::herdFacts(implOf(crowd), of), now));
    }
  }
  // `device` are the states of crowd::allRuns().
  void tick(const std::vector<HerdState>& device) {
    auto state = device.begin();
    for (const auto& [key, run] : runs_) run->tick((state++)->watched);
  }
  double shareWithin(const Crowd& crowd, const States& device) const {
    double agents = 0, within = 0;
    for (const crowd::HerdRun& of : crowd::allRuns(implOf(crowd))) {
      const double here = of.agentCount();
      agents += here;
      within += runs_.at(of.key())->shareWithin(device.at(of.key()), freeRunTolerance) * here;
    }
    return agents > 0 ? within / agents : 1;
  }

 private:
  std::map<crowd::RunKey, std::unique_ptr<validation::FreeRun>> runs_;  // in the order of crowd::allRuns()
};

// A validation under way: what may be told when it is ended from another thread.
struct Validation {
  const ValidateOptions& options;
  const Scene& scene;
  bool several;  // devices
  Manifest manifest;
  Heightfield terrain = {};
  std::vector<Outcome> outcomes = {};  // of the devices that are done
  std::string device = {};             // at work
  std::atomic<uint64_t> done = 0;      // its ticks

  void write(std::span<const Outcome> all) const {
    if (!options.json.empty()) writeJson(options.json, jsonOf(all, several), manifest);
    if (!options.junit.empty()) writeJunit(options.junit, all, manifest);
  }
  // Without the stages of the device that is at work.
  std::string leave() const {
    std::vector<Outcome> all = outcomes;
    all.push_back({.device = device, .ticks = done, .wanted = options.frames});
    write(all);
    return interruptedAfter(done, options.frames, "ticks");
  }
};

// Where there are levels of rate: a camera that rises from the ground beyond all of them and comes down
// again, so that every rate and every change of it is compared.
class LevelSweep {
 public:
  static std::optional<LevelSweep> of(const Crowd& crowd) {
    const auto& rates = implOf(crowd).rates;
    if (!rates) return {};
    return LevelSweep(double{rates->levels.distances.back()});
  }
  // Its height grows and falls by the same share a tick.
  glm::vec3 cameraAt(uint64_t tick) const {
    const double share = 1 - std::abs(1 - 2 * static_cast<double>(tick % period) / period);
    return {0, static_cast<float>(std::pow(2 * farthest_ + 1, share)), 0};
  }

 private:
  explicit LevelSweep(double farthest) : farthest_(farthest) {}

  static constexpr uint64_t period = 120;  // ticks
  double farthest_;                        // metres
};

Outcome replay(Validation& validation, Device& device, Crowd& crowd) {
  const ValidateOptions& options = validation.options;
  const Scene& scene = validation.scene;
  gpu::CommandRing ring(device.context());
  TickTimes times;
  Outcome outcome{.device = device.report().name, .wanted = options.frames};
  const auto began = std::chrono::steady_clock::now();
  const auto dt = static_cast<float>(options.scene.dt);
  Lockstep lockstep(crowd, scene, dt, options.stages);
  std::optional<FreeRuns> freeRuns;
  if (options.freeRun) freeRuns.emplace(crowd);
  std::optional<GroundEdits> edits;
  if (options.edits) {
    edits.emplace(crowd.terrain(), scene.seed, options.scene.dt);
    outcome.edits = 0;
  }
  LawWatch laws(crowd, scene, options.scene.dt, defaultAgents);
  const std::optional<LevelSweep> sweep = LevelSweep::of(crowd);
  Progress progress("ticks", options.frames, options.quiet);
  while (crowd.tick() < options.frames && !stopRequested()) {
    States untold;
    if (freeRuns && !scene.events.empty()) untold = download(crowd);
    const std::vector<HerdState>& before = lockstep.begin();
    if (freeRuns && !scene.events.empty()) freeRuns->follow(crowd, untold, download(crowd));
    if (edits) {
      for (const HeightEdit& e : edits->before(crowd.tick(), crowd, before)) {
        lockstep.edit(e.x, e.z, e.columns, e.rows, e.heights);
        ++*outcome.edits;
      }
    }
    if (sweep) crowd.lookFrom(sweep->cameraAt(crowd.tick() + 1));
    runTick(ring, crowd, dt, times);
    const std::vector<HerdState>& after = lockstep.end();
    laws.look(crowd);
    if (freeRuns) freeRuns->tick(after);
    validation.done = crowd.tick();
    progress.update(validation.done);
  }
  outcome.stages = lockstep.results();
  outcome.laws = laws.figures();
  outcome.ticks = crowd.tick();
  if (freeRuns) outcome.freeShare = freeRuns->shareWithin(crowd, download(crowd));
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return outcome;
}

Outcome validateOn(const std::string& name, Validation& validation, Files& files) {
  const ValidateOptions& options = validation.options;
  const auto leave = [&] { return validation.leave(); };
  std::optional<StopDeadline> deadline(leave);
  DeviceRequest request;
  if (!name.empty()) request.device = name;
  Device device = Device::create(request);
  const ModelWarnings warnings;
  CrowdOptions crowdOptions;
  if (!options.levels.empty()) crowdOptions.levels = loadLevels(options.levels);
  // All that can be.
  if (!crowdOptions.levels && !validation.scene.levels) crowdOptions.footfalls = UINT32_MAX;
  crowdOptions.sleep = options.sleep;
  crowdOptions.fuse = !options.apart;
  crowdOptions.pageAgents = options.pageAgents;
  Crowd crowd(device, validation.terrain, validation.scene, crowdOptions);
  deadline.reset();
  validation.device = device.report().name;
  validation.manifest.add(device.report());
  files.check();
  deadline.emplace(leave);
  return replay(validation, device, crowd);
}

// As the user wants it, otherwise with few agents; but all of a scene whose events name some by number.
Scene sceneOf(SceneOptions options) {
  Scene scene = options.load();
  if (options.agents || std::ranges::any_of(scene.events, crowd::namesAgents)) return scene;
  options.agents = defaultAgents;
  return options.load();
}

void refuseFreeRunOf(const ValidateOptions& options, const Scene& scene) {
  if (options.freeRun && (scene.levels || !options.levels.empty()))
    throw inputError(
        "--free-run with levels of rate, expected only one of them: the reference has no camera");
  for (size_t h = 0; options.freeRun && h < scene.herds.size(); ++h)
    if (scene.herds[h].forage)
      throw inputError(
          fmt::format("--free-run: herds[{}] of {} forages, expected none: the reference walks each agent by "
                      "itself",
                      h, scene.name));
  for (size_t h = 0; options.freeRun && h < scene.herds.size(); ++h)
    if (scene.herds[h].avoid)
      throw inputError(
          fmt::format("--free-run: herds[{}].avoid of {} is true, expected false: the reference walks each "
                      "herd by itself",
                      h, scene.name));
}

int validate(const ValidateOptions& options) {
  if (options.timeout) stopAfter(*options.timeout);
  Files files;
  files.writes("--json", options.json);
  files.writes("--junit", options.junit);
  if (options.levels != "default") files.reads("--levels", options.levels);
  const Scene scene = sceneOf(options.scene);
  options.scene.declare(files, scene);
  files.check();
  validation::expectComparable(scene, options.stages, "--stages");
  refuseFreeRunOf(options, scene);
  Validation validation{.options = options,
                        .scene = scene,
                        .several = options.scene.device == "all",
                        .manifest = {.scene = &scene, .dt = options.scene.dt}};
  {
    const StopDeadline deadline([&] { return validation.leave(); });
    validation.terrain = scene.loadTerrain();
  }
  validation.manifest.terrain = &validation.terrain;
  for (const std::string& name : options.scene.devices()) {
    validation.device = "";
    validation.done = 0;
    if (stopRequested()) throw Interrupted(validation.leave());
    validation.outcomes.push_back(validateOn(name, validation, files));
    print(validation.outcomes.back(), scene);
  }
  const std::vector<Outcome>& outcomes = validation.outcomes;
  validation.write(outcomes);
  std::string failed;
  for (const Outcome& outcome : outcomes) {
    if (!outcome.isWhole()) throw Interrupted(interruptedAfter(outcome.ticks, outcome.wanted, "ticks"));
    if (outcome.failed().empty()) continue;
    failed += fmt::format("{}{}{}", failed.empty() ? "" : "; ",
                          validation.several ? outcome.device + ": " : "", outcome.failed());
  }
  if (!failed.empty())
    throw Error(Error::Kind::check, fmt::format("stages differ from the reference: {}", failed));
  if (options.strict)
    for (const Outcome& outcome : outcomes) refuseBroken(brokenOf(outcome.laws));
  return 0;
}

}  // namespace

void addValidate(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<ValidateOptions>();
  CLI::App* command = app.add_subcommand(
      "validate", "Replay a scene in lock-step: every stage, every tick, against the CPU reference");
  options->scene.addTo(*command,
                       fmt::format("{}; the scene's, where its events name agents", defaultAgents).c_str());
  command
      ->add_option_function<std::string>(
          "--frames",
          [options](const std::string& text) {
            options->frames = parseWhole("--frames", text, 1, mostFrames);
          },
          fmt::format("ticks to compare [{}]", defaultFrames))
      ->type_name("N");
  command
      ->add_option_function<std::string>(
          "--stages",
          [options](const std::string& text) {
            options->stages = parseNames("--stages", text, crowd::allStages);
          },
          "compare only these stages [all that the herds have]")
      ->type_name("NAME,NAME,..");
  command
      ->add_option_function<std::string>(
          "--timeout",
          [options](const std::string& text) {
            options->timeout = parseNumber("--timeout", text, 0.001, longestTimeout);
          },
          "stop after so long, with exit code 1 and \"timedOut\" in the JSON; also where a device hangs "
          "[never]")
      ->type_name("SECONDS");
  command->add_option("--json", options->json, "write the table to a file")->type_name("FILE");
  command
      ->add_option("--junit", options->junit,
                   "write a report in JUnit's XML: a suite a device, a case a stage; and a suite of its laws")
      ->type_name("FILE");
  command->add_flag("--edits", options->edits,
                    "raise and lower the ground under the crowd: blocks and pits near agents, four times in "
                    "the first second of every four");
  command->add_flag("--free-run", options->freeRun,
                    "also walk every herd by the reference alone, and say what share stays together");
  command->add_flag("--sleep", options->sleep, "let agents that have stood still for seconds sleep");
  command
      ->add_option("--levels", options->levels,
                   "let blocks tick at rates of their own, as skitter run does; the camera rises beyond all "
                   "distances and comes down again every 120 ticks [those of the scene, else none]")
      ->type_name("default|FILE");
  command->add_flag("--apart", options->apart,
                    "dispatch every stage by itself, also those that are faster when fused");
  command
      ->add_option_function<std::string>(
          "--page-agents",
          [options](const std::string& text) {
            options->pageAgents =
                static_cast<uint32_t>(parseWhole("--page-agents", text, 1, Scene::maxAgents));
          },
          "most agents of a page of records [as many as the device's limits allow]")
      ->type_name("N");
  command->add_flag("--strict", options->strict,
                    "a law of the visible world that is broken (docs/laws.md) fails, too");
  command->add_flag("--quiet", options->quiet, "no progress on stderr");
  command->footer(fmt::format(
      "Of more than {} agents of one size in a herd a part is compared, another one in each tick.\n"
      "\n"
      "A stage passes if all of its samples are within their tolerances and there was something to "
      "compare. Samples are agents or legs, or joints of a clip's skin, in a tick; kept are "
      "records that had to stay as they were and did: a sleeper's, and steps of legs that begin "
      "none. In a tie the device decided otherwise than the reference, which rounding allows, "
      "and all else is right for what it decided.\n"
      "\n"
      "Interrupted, the table and the files tell of the ticks that were done. --device all validates on "
      "every suitable device, one after the other.\n"
      "\n"
      "Examples:\n"
      "  skitter validate\n"
      "  skitter validate --edits --controller planted\n"
      "  skitter validate scene.json --agents 256 --frames 600 --json validation.json\n"
      "  skitter validate --device all --stages foothold,ik --junit report.xml --timeout 300",
      Lockstep::agentsATick));
  command->callback([options, &chosen] { chosen = [options] { return validate(*options); }; });
}

}  // namespace skitter::app

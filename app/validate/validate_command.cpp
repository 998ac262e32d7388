#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/common/files.h"
#include "app/common/manifest.h"
#include "app/common/progress.h"
#include "app/common/scene_options.h"
#include "app/common/signals.h"
#include "app/common/simulate.h"
#include "app/common/values.h"
#include "app/validate/ground_edits.h"
#include "app/validate/outcome.h"
#include "crowd/changes.h"
#include "crowd/events.h"
#include "crowd/herd.h"
#include "crowd/setup.h"
#include "gpu/submit.h"
#include "skitter/error.h"
#include "validation/free_run.h"
#include "validation/herd_facts.h"

namespace skitter::app {
namespace {

using validation::Replay;
using validation::StageResult;

constexpr uint64_t defaultAgents = 64, defaultFrames = 120, maxFrames = 1000000;
constexpr double longestTimeout = 1e6;  // seconds
// The reference takes about a millisecond for one of them; of larger herds every so many-th agent is
// compared, others in each tick.
constexpr uint32_t agentsATick = 1024;

struct ValidateOptions {
  SceneOptions scene;
  uint64_t frames = defaultFrames;
  std::string json, junit;
  std::vector<crowd::StageId> stages;  // that are compared; none: all
  std::optional<double> timeout;       // seconds
  bool apart = false, edits = false, freeRun = false, quiet = false, sleep = false;
  uint32_t pageAgents = 0;  // 0: as many as the device allows
};

// Beside the device's crowd: the same herds walked by the reference alone, from the same first state.
class FreeRuns {
 public:
  FreeRuns(const Crowd& crowd, const std::vector<HerdState>& first) {
    for (uint32_t h = 0; h < first.size(); ++h)
      runs_.push_back(std::make_unique<validation::FreeRun>(
          validation::herdFacts(implOf(crowd).kindOf(h), implOf(crowd).terrain), first[h]));
  }
  void follow(const std::vector<HerdState>& before, const std::vector<HerdState>& after) {
    for (size_t h = 0; h < runs_.size(); ++h) runs_[h]->follow(before[h], after[h]);
  }
  void tick(const std::vector<HerdState>& device) {
    for (size_t h = 0; h < runs_.size(); ++h) runs_[h]->tick(device[h].watched);
  }
  double shareWithin(const Crowd& crowd, const std::vector<HerdState>& device) const {
    double agents = 0, within = 0;
    for (uint32_t h = 0; h < runs_.size(); ++h) {
      agents += crowd.agentCount(h);
      within += runs_[h]->shareWithin(device[h], freeRunTolerance) * crowd.agentCount(h);
    }
    return agents > 0 ? within / agents : 1;
  }

 private:
  std::vector<std::unique_ptr<validation::FreeRun>> runs_;
};

std::vector<std::unique_ptr<Replay>> replaysOf(const Crowd& crowd, const std::vector<crowd::StageId>& only) {
  std::vector<std::unique_ptr<Replay>> replays;
  for (uint32_t h = 0; h < crowd.herdCount(); ++h)
    replays.push_back(std::make_unique<Replay>(
        validation::herdFacts(implOf(crowd).kindOf(h), implOf(crowd).terrain), only));
  return replays;
}

// What the next tick compares of every herd.
std::vector<AgentSample> samplesOf(const Crowd& crowd, uint64_t seed) {
  std::vector<AgentSample> samples;
  for (uint32_t h = 0; h < crowd.herdCount(); ++h)
    samples.push_back(validation::sampleAt(seed, crowd.tick() + 1, crowd.places(h), agentsATick));
  return samples;
}

std::vector<HerdState> download(const Crowd& crowd, const std::vector<AgentSample>& samples) {
  std::vector<HerdState> states;
  for (uint32_t h = 0; h < crowd.herdCount(); ++h) states.push_back(crowd.download(h, samples[h]));
  return states;
}

std::vector<HerdState> download(const Crowd& crowd) {
  return download(crowd, std::vector<AgentSample>(crowd.herdCount()));
}

// What the scene has for the next tick happens now: the states before the tick then show what agents were
// told, and the reference begins with it as the tick does.
void letEventsHappen(Crowd& crowd, const std::vector<std::unique_ptr<Replay>>& replays,
                     std::optional<FreeRuns>& freeRuns) {
  Crowd::Impl& impl = implOf(crowd);
  crowd::letEventsHappen(crowd);
  const Heightfield& ground = crowd.terrain();
  for (const Event& event : crowd::eventsAt(impl.events, crowd.tick() + 1, double{impl.dt})) {
    const crowd::Rectangle at = crowd::groundOf(event, ground);
    std::vector<float> heights;
    for (uint32_t row = at.z; row < at.z + at.rows; ++row) {
      const auto first = ground.heights.begin() + static_cast<std::ptrdiff_t>(row) * ground.columns + at.x;
      heights.insert(heights.end(), first, first + at.columns);
    }
    for (const auto& replay : replays) replay->edit(at.x, at.z, at.columns, at.rows, heights);
  }
  if (!crowd::changesWait(impl)) return;
  std::vector<HerdState> before;
  if (freeRuns) before = download(crowd);
  crowd::applyChanges(impl);
  if (freeRuns) freeRuns->follow(before, download(crowd));
}

void add(const StageResult& result, StageResult& sum) {
  const bool worse = result.pass == sum.pass ? result.ratio() > sum.ratio() : !result.pass;
  if (worse) {
    sum.maxError = result.maxError;
    sum.tolerance = result.tolerance;
    sum.worst = result.worst;
  }
  sum.samples += result.samples;
  sum.kept += result.kept;
  sum.ties += result.ties;
  sum.pass = sum.pass && result.pass;
  if (!result.pass) sum.why += (sum.why.empty() ? "" : "; ") + result.why;
}

// Adds up the results of all herds that have places, by stage; the worst herd gives a stage's error.
std::vector<StageResult> merge(const Scene& scene, const std::vector<std::unique_ptr<Replay>>& replays) {
  std::vector<StageResult> all;
  for (const crowd::StageId stage : crowd::allStages) {
    const char* name = nameOf(stage);
    StageResult* sum = nullptr;
    for (size_t h = 0; h < replays.size(); ++h) {
      if (scene.herds[h].agents == 0 && scene.herds[h].reserve == 0) continue;
      for (StageResult result : replays[h]->results()) {
        if (result.name != name) continue;
        if (replays.size() > 1) {
          result.worst = fmt::format("herd {}: {}", h, result.worst);
          if (!result.pass) result.why = fmt::format("herd {}: {}", h, result.why);
        }
        if (sum != nullptr)
          add(result, *sum);
        else
          sum = &all.emplace_back(result);
      }
    }
  }
  return all;
}

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

Outcome replay(Validation& validation, Device& device, Crowd& crowd) {
  const ValidateOptions& options = validation.options;
  const Scene& scene = validation.scene;
  gpu::CommandRing ring(device.context());
  TickTimes times;
  Outcome outcome{.device = device.report().name, .wanted = options.frames};
  const auto began = std::chrono::steady_clock::now();
  const auto dt = static_cast<float>(options.scene.dt);
  crowd::setTick(implOf(crowd), dt);  // which herds' parameters depend on
  const std::vector<std::unique_ptr<Replay>> replays = replaysOf(crowd, options.stages);
  std::optional<FreeRuns> freeRuns;
  if (options.freeRun) freeRuns.emplace(crowd, download(crowd));
  std::optional<GroundEdits> edits;
  if (options.edits) {
    edits.emplace(crowd, scene.seed, options.scene.dt);
    outcome.edits = 0;
  }
  Progress progress("ticks", options.frames, options.quiet);
  while (crowd.tick() < options.frames && !stopRequested()) {
    letEventsHappen(crowd, replays, freeRuns);
    const std::vector<AgentSample> samples = samplesOf(crowd, scene.seed);
    const std::vector<HerdState> before = download(crowd, samples);
    if (edits) {
      for (const HeightEdit& e : edits->before(crowd.tick(), before)) {
        crowd.editHeights(e.x, e.z, e.columns, e.rows, e.heights);
        for (const auto& replay : replays) replay->edit(e.x, e.z, e.columns, e.rows, e.heights);
        ++*outcome.edits;
      }
    }
    runTick(ring, crowd, dt, times);
    const std::vector<HerdState> after = download(crowd, samples);
    if (freeRuns) freeRuns->tick(after);
    for (size_t h = 0; h < replays.size(); ++h) replays[h]->tick(crowd.tick(), before[h], after[h]);
    validation.done = crowd.tick();
    progress.update(validation.done);
  }
  outcome.stages = merge(scene, replays);
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
  CrowdOptions crowdOptions;
  crowdOptions.footfalls = UINT32_MAX;  // all that can be
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

// Every stage that is asked for is one that some herd has compared.
void checkStages(const std::vector<crowd::StageId>& stages, const Scene& scene) {
  std::vector<crowd::StageId> compared;
  for (const crowd::StageId stage : crowd::allStages)
    for (const Herd& herd : scene.herds)
      for (const validation::CheckedStage& checked : validation::checkedStages(herd.controller))
        if (checked.stage == stage) compared.push_back(stage);
  for (const crowd::StageId stage : stages)
    if (std::ranges::find(compared, stage) == compared.end())
      throw inputError(fmt::format("--stages: no herd of {} has {} compared", scene.name, nameOf(stage)));
}

// As the user wants it, otherwise with few agents; but all of a scene whose events name some by number.
Scene sceneOf(SceneOptions options) {
  Scene scene = options.load();
  if (options.agents || std::ranges::any_of(scene.events, crowd::namesAgents)) return scene;
  options.agents = defaultAgents;
  return options.load();
}

bool hasAgents(const Scene& scene) {
  return scene.agentCount() > 0 || std::ranges::any_of(scene.events, [](const Event& event) {
           return std::holds_alternative<Addition>(event.what);
         });
}

int validate(const ValidateOptions& options) {
  if (options.timeout) stopAfter(*options.timeout);
  Files files;
  files.writes("--json", options.json);
  files.writes("--junit", options.junit);
  const Scene scene = sceneOf(options.scene);
  options.scene.declare(files, scene);
  files.check();
  if (!hasAgents(scene))
    throw inputError(fmt::format("{} has no agents, expected at least one to compare", scene.name));
  checkStages(options.stages, scene);
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
            options->frames = parseWhole("--frames", text, 1, maxFrames);
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
                   "write a report in JUnit's XML: a suite a device, a case a stage")
      ->type_name("FILE");
  command->add_flag("--edits", options->edits,
                    "raise and lower the ground under the crowd: blocks and pits near agents, four times in "
                    "the first second of every four");
  command->add_flag("--free-run", options->freeRun,
                    "also walk every herd by the reference alone, and say what share stays together");
  command->add_flag("--sleep", options->sleep, "let agents that have stood still for seconds sleep");
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
  command->add_flag("--quiet", options->quiet, "no progress on stderr");
  command->footer(fmt::format(
      "Of herds of more than {} agents a part is compared, another one in each tick.\n"
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
      agentsATick));
  command->callback([options, &chosen] { chosen = [options] { return validate(*options); }; });
}

}  // namespace skitter::app

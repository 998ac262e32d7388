#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
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
#include "crowd/herd.h"
#include "gpu/submit.h"
#include "skitter/error.h"
#include "validation/free_run.h"
#include "validation/herd_facts.h"

namespace skitter::app {
namespace {

using validation::Replay;
using validation::StageResult;

constexpr uint64_t defaultAgents = 64, defaultFrames = 120, maxFrames = 1000000;
// The reference takes about a millisecond for one of them; of larger herds every so many-th agent is
// compared, others in each tick.
constexpr uint32_t agentsATick = 1024;

struct ValidateOptions {
  SceneOptions scene;
  uint64_t frames = defaultFrames;
  std::string json;
  bool apart = false, edits = false, freeRun = false, quiet = false, sleep = false;
  uint32_t pageAgents = 0;  // 0: as many as the device allows
};

// A share of a leg length. Nobody sees a difference of so little in where an agent stands.
constexpr double freeRunTolerance = 0.01;

// Beside the device's crowd: the same herds walked by the reference alone, from the same first state.
class FreeRuns {
 public:
  FreeRuns(const Crowd& crowd, const std::vector<HerdState>& first) {
    for (uint32_t h = 0; h < first.size(); ++h)
      runs_.push_back(std::make_unique<validation::FreeRun>(
          validation::herdFacts(implOf(crowd).kindOf(h), implOf(crowd).terrain), first[h]));
  }
  void tick(const std::vector<HerdState>& device) {
    for (size_t h = 0; h < runs_.size(); ++h) runs_[h]->tick(device[h].watched);
  }
  double shareWithin(const std::vector<HerdState>& device) const {
    double agents = 0, within = 0;
    for (size_t h = 0; h < runs_.size(); ++h) {
      agents += device[h].agents;
      within += runs_[h]->shareWithin(device[h], freeRunTolerance) * device[h].agents;
    }
    return agents > 0 ? within / agents : 1;
  }

 private:
  std::vector<std::unique_ptr<validation::FreeRun>> runs_;
};

std::vector<std::unique_ptr<Replay>> replaysOf(const Crowd& crowd) {
  std::vector<std::unique_ptr<Replay>> replays;
  for (uint32_t h = 0; h < crowd.herdCount(); ++h)
    replays.push_back(
        std::make_unique<Replay>(validation::herdFacts(implOf(crowd).kindOf(h), implOf(crowd).terrain)));
  return replays;
}

// What tick n compares of every herd.
std::vector<AgentSample> samplesAt(uint64_t n, const Scene& scene) {
  std::vector<AgentSample> samples;
  for (const Herd& herd : scene.herds)
    samples.push_back(validation::sampleAt(scene.seed, n, herd.agents, agentsATick));
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

double ratioOf(const StageResult& result) {
  if (result.tolerance > 0) return result.maxError / result.tolerance;
  return result.maxError > 0 ? HUGE_VAL : 0;
}

void add(const StageResult& result, StageResult& sum) {
  const bool worse = result.pass == sum.pass ? ratioOf(result) > ratioOf(sum) : !result.pass;
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

// Adds up the results of all herds that have agents, by stage; the worst herd gives a stage's error.
std::vector<StageResult> merge(const Scene& scene, const std::vector<std::unique_ptr<Replay>>& replays) {
  std::vector<StageResult> all;
  for (const crowd::StageId stage : crowd::allStages) {
    const char* name = nameOf(stage);
    StageResult* sum = nullptr;
    for (size_t h = 0; h < replays.size(); ++h) {
      if (scene.herds[h].agents == 0) continue;
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

void print(const Device& device, const Scene& scene, uint64_t ticks,
           const std::vector<StageResult>& results) {
  fmt::print("{}: {} agents, {} ticks, seed {}\n", device.report().name, scene.agentCount(), ticks,
             scene.seed);
  fmt::print("{}", validation::table(results));
  const auto closest = std::max_element(results.begin(), results.end(),
                                        [](const auto& a, const auto& b) { return ratioOf(a) < ratioOf(b); });
  if (closest != results.end() && closest->pass && closest->samples > 0) {
    fmt::print("closest to its tolerance: {}: {}\n", closest->name, closest->worst);
  }
}

// A validation's results.
struct Outcome {
  std::vector<StageResult> stages;
  uint64_t ticks = 0;           // done
  uint64_t edits = 0;           // of the ground, rectangles
  std::optional<double> share;  // of the free run

  std::string failed() const {
    std::string names;
    for (const StageResult& stage : stages)
      if (!stage.pass) names += (names.empty() ? "" : ", ") + stage.name;
    return names;
  }
};

nlohmann::ordered_json describe(const Device& device, const ValidateOptions& options,
                                const Outcome& outcome) {
  nlohmann::ordered_json stages = nlohmann::ordered_json::array();
  for (const StageResult& result : outcome.stages) {
    stages.push_back({{"name", result.name},
                      {"samples", result.samples},
                      {"kept", result.kept},
                      {"maxError", result.maxError},
                      {"tolerance", result.tolerance},
                      {"ties", result.ties},
                      {"worst", result.worst},
                      {"pass", result.pass},
                      {"why", result.why}});
  }
  const bool interrupted = outcome.ticks < options.frames;
  nlohmann::ordered_json json = {{"device", device.report().name},
                                 {"ticks", outcome.ticks},
                                 {"ticksWanted", options.frames},
                                 {"interrupted", interrupted},
                                 {"stages", stages}};
  if (options.edits) json["edits"] = outcome.edits;
  if (outcome.share) json["freeRunShare"] = *outcome.share;
  json["pass"] = outcome.failed().empty() && !interrupted;
  return json;
}

// `done` is how many ticks are, for another thread to see.
Outcome replay(const ValidateOptions& options, const Scene& scene, Device& device, Crowd& crowd,
               std::atomic<uint64_t>& done) {
  gpu::CommandRing ring(device.context());
  TickTimes times;
  Outcome outcome;
  std::vector<std::unique_ptr<Replay>> replays;
  std::optional<FreeRuns> freeRuns;
  std::optional<GroundEdits> edits;
  if (options.edits) edits.emplace(crowd, scene.seed, options.scene.dt);
  Progress progress("ticks", options.frames, options.quiet);
  while (crowd.tick() < options.frames && !stopRequested()) {
    const std::vector<AgentSample> samples = samplesAt(crowd.tick() + 1, scene);
    const std::vector<HerdState> before = download(crowd, samples);
    std::vector<HerdState> first;
    if (options.freeRun && !freeRuns) first = download(crowd);
    // Before the first tick there is nobody to tell of an edit.
    if (edits && !replays.empty()) {
      for (const HeightEdit& e : edits->before(crowd.tick(), before)) {
        crowd.editHeights(e.x, e.z, e.columns, e.rows, e.heights);
        for (const auto& replay : replays) replay->edit(e.x, e.z, e.columns, e.rows, e.heights);
        ++outcome.edits;
      }
    }
    runTick(ring, crowd, static_cast<float>(options.scene.dt), times);
    // A herd's parameters are complete only once the length of a tick is known.
    if (replays.empty()) replays = replaysOf(crowd);
    if (options.freeRun && !freeRuns) freeRuns.emplace(crowd, first);
    const std::vector<HerdState> after = download(crowd, samples);
    if (freeRuns) freeRuns->tick(after);
    for (size_t h = 0; h < replays.size(); ++h) replays[h]->tick(crowd.tick(), before[h], after[h]);
    done = crowd.tick();
    progress.update(done);
  }
  if (replays.empty()) replays = replaysOf(crowd);
  outcome.stages = merge(scene, replays);
  outcome.ticks = crowd.tick();
  if (freeRuns) outcome.share = freeRuns->shareWithin(download(crowd));
  return outcome;
}

int validate(const ValidateOptions& options) {
  Files files;
  files.writes("--json", options.json);
  const Scene scene = options.scene.load();
  options.scene.declare(files, scene);
  files.check();
  if (scene.agentCount() == 0)
    throw inputError(fmt::format("{} has no agents, expected at least one to compare", scene.name));
  Manifest manifest{.scene = &scene, .dt = options.scene.dt};
  std::atomic<uint64_t> done = 0;
  const auto leave = [&] {
    if (!options.json.empty()) {
      const nlohmann::ordered_json json = {{"ticks", done.load()},
                                           {"ticksWanted", options.frames},
                                           {"interrupted", true},
                                           {"stages", nlohmann::ordered_json::array()},
                                           {"pass", false}};
      writeJson(options.json, json, manifest);
    }
    return interruptedAfter(done, options.frames, "ticks");
  };
  std::optional<StopDeadline> deadline(std::in_place, leave);
  const Heightfield terrain = scene.loadTerrain();
  DeviceRequest request;
  request.device = options.scene.device;
  Device device = Device::create(request);
  CrowdOptions crowdOptions;
  crowdOptions.footfalls = UINT32_MAX;  // all that can be
  crowdOptions.sleep = options.sleep;
  crowdOptions.fuse = !options.apart;
  crowdOptions.pageAgents = options.pageAgents;
  Crowd crowd(device, terrain, scene, crowdOptions);

  deadline.reset();
  manifest.terrain = &terrain;
  manifest.add(device.report());
  files.check();
  deadline.emplace(leave);
  const Outcome outcome = replay(options, scene, device, crowd, done);
  deadline.reset();
  print(device, scene, outcome.ticks, outcome.stages);
  if (options.edits) fmt::print("edits of the ground: {}\n", outcome.edits);
  if (outcome.share)
    fmt::print(
        "free run: {:.1f} % of the agents within {:g} % of leg length of where the reference alone has "
        "them\n",
        100 * *outcome.share, 100 * freeRunTolerance);
  if (!options.json.empty()) writeJson(options.json, describe(device, options, outcome), manifest);
  if (outcome.ticks < options.frames)
    throw Interrupted(interruptedAfter(outcome.ticks, options.frames, "ticks"));
  if (!outcome.failed().empty())
    throw Error(Error::Kind::check, fmt::format("stages differ from the reference: {}", outcome.failed()));
  return 0;
}

}  // namespace

void addValidate(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<ValidateOptions>();
  options->scene.agents = defaultAgents;
  CLI::App* command = app.add_subcommand(
      "validate", "Replay a scene in lock-step: every stage, every tick, against the CPU reference");
  options->scene.addTo(*command, fmt::format("{}", defaultAgents).c_str());
  command
      ->add_option_function<std::string>(
          "--frames",
          [options](const std::string& text) {
            options->frames = parseWhole("--frames", text, 1, maxFrames);
          },
          fmt::format("ticks to compare [{}]", defaultFrames))
      ->type_name("N");
  command->add_option("--json", options->json, "write the table to a file")->type_name("FILE");
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
      "Interrupted, the table and the file tell of the ticks that were done.\n"
      "\n"
      "Examples:\n"
      "  skitter validate\n"
      "  skitter validate --edits --controller planted\n"
      "  skitter validate scene.json --agents 256 --frames 600 --json validation.json",
      agentsATick));
  command->callback([options, &chosen] { chosen = [options] { return validate(*options); }; });
}

}  // namespace skitter::app

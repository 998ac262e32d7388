#include "validation/free_run.h"
#include "validation/herd_facts.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "crowd/herd.h"
#include "gpu/submit.h"
#include "part_file.h"
#include "progress.h"
#include "scene_options.h"
#include "signals.h"
#include "simulate.h"
#include "skitter/error.h"
#include "validation/herd_facts.h"
#include "values.h"

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
  bool freeRun = false, quiet = false, sleep = false;
};

// Of a leg length: where an agent stands, after so long, is the same place to whoever looks.
constexpr double freeRunTolerance = 0.01;

// Beside the device's crowd: the same herds walked by the reference alone, from the same first state.
class FreeRuns {
 public:
  FreeRuns(const Crowd& crowd, const std::vector<HerdState>& first) {
    for (size_t h = 0; h < first.size(); ++h)
      runs_.push_back(std::make_unique<validation::FreeRun>(
          validation::herdFacts(crowd.impl().herds[h], crowd.impl().terrain), first[h]));
  }
  void tick() {
    for (const auto& run : runs_) run->tick();
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
  for (const crowd::Herd& herd : crowd.impl().herds) {
    replays.push_back(std::make_unique<Replay>(validation::herdFacts(herd, crowd.impl().terrain)));
  }
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
  const uint64_t samples = sum.samples + result.samples, ties = sum.ties + result.ties;
  if (worse) sum = result;
  sum.samples = samples;
  sum.ties = ties;
}

// Of all herds, by stage; the worst herd gives a stage's error.
std::vector<StageResult> merge(const std::vector<std::unique_ptr<Replay>>& replays) {
  std::vector<StageResult> all;
  for (const char* name : crowd::frame()) {
    StageResult* sum = nullptr;
    for (size_t h = 0; h < replays.size(); ++h) {
      for (StageResult result : replays[h]->results()) {
        if (result.name != name) continue;
        if (replays.size() > 1) result.worst = fmt::format("herd {}: {}", h, result.worst);
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

nlohmann::ordered_json describe(const Device& device, const std::vector<StageResult>& results,
                                const std::optional<double>& freeRunShare, bool pass) {
  nlohmann::ordered_json stages = nlohmann::ordered_json::array();
  for (const StageResult& result : results) {
    stages.push_back({{"name", result.name},
                      {"samples", result.samples},
                      {"maxError", result.maxError},
                      {"tolerance", result.tolerance},
                      {"ties", result.ties},
                      {"pass", result.pass}});
  }
  nlohmann::ordered_json json = {{"device", device.report().name}, {"stages", stages}};
  if (freeRunShare) json["freeRunShare"] = *freeRunShare;
  json["pass"] = pass;
  return json;
}

int validate(const ValidateOptions& options) {
  if (!options.json.empty()) checkFileTarget("--json", options.json);
  const Scene scene = options.scene.load();
  const Heightfield terrain = scene.loadTerrain();
  DeviceRequest request;
  request.device = options.scene.device;
  Device device = Device::create(request);
  CrowdOptions crowdOptions;
  crowdOptions.footfalls = UINT32_MAX;  // all that can be
  crowdOptions.sleep = options.sleep;
  Crowd crowd(device, terrain, scene, crowdOptions);

  gpu::CommandRing ring(device.context());
  TickTimes times;
  std::vector<std::unique_ptr<Replay>> replays;
  std::optional<FreeRuns> freeRuns;
  Progress progress("ticks", options.frames, options.quiet);
  while (crowd.tick() < options.frames && !stopRequested()) {
    const std::vector<AgentSample> samples = samplesAt(crowd.tick() + 1, scene);
    const std::vector<HerdState> before = download(crowd, samples);
    std::vector<HerdState> first;
    if (options.freeRun && !freeRuns) first = download(crowd);
    runTick(ring, crowd, static_cast<float>(options.scene.dt), times);
    // A herd's parameters are complete only once the length of a tick is known.
    if (replays.empty()) replays = replaysOf(crowd);
    if (options.freeRun && !freeRuns) freeRuns.emplace(crowd, first);
    if (freeRuns) freeRuns->tick();
    const std::vector<HerdState> after = download(crowd, samples);
    for (size_t h = 0; h < replays.size(); ++h) replays[h]->tick(crowd.tick(), before[h], after[h]);
    progress.update(crowd.tick());
  }
  if (replays.empty()) replays = replaysOf(crowd);

  const std::vector<StageResult> results = merge(replays);
  std::string failed;
  for (const StageResult& result : results) {
    if (!result.pass) failed += (failed.empty() ? "" : ", ") + result.name;
  }
  print(device, scene, crowd.tick(), results);
  std::optional<double> share;
  if (freeRuns) {
    share = freeRuns->shareWithin(download(crowd));
    fmt::print(
        "free run: {:.1f} % of the agents within {:g} % of leg length of where the reference alone has "
        "them\n",
        100 * *share, 100 * freeRunTolerance);
  }
  if (!options.json.empty())
    writeText(options.json, describe(device, results, share, failed.empty()).dump(2) + "\n");
  if (!failed.empty())
    throw Error(Error::Kind::check, fmt::format("stages differ from the reference: {}", failed));
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
            options->frames = parseWhole("--frames", text, 0, maxFrames);
          },
          fmt::format("ticks to compare [{}]", defaultFrames))
      ->type_name("N");
  command->add_option("--json", options->json, "write the table to a file")->type_name("FILE");
  command->add_flag("--free-run", options->freeRun,
                    "also walk adaptive herds by the reference alone, and say what share stays together");
  command->add_flag("--sleep", options->sleep, "let agents that have stood still for seconds sleep");
  command->add_flag("--quiet", options->quiet, "no progress on stderr");
  command->footer(
      fmt::format("Of herds of more than {} agents a part is compared, another one in each tick.\n"
                  "\n"
                  "Examples:\n"
                  "  skitter validate\n"
                  "  skitter validate scene.json --agents 256 --frames 600 --json validation.json",
                  agentsATick));
  command->callback([options, &chosen] { chosen = [options] { return validate(*options); }; });
}

}  // namespace skitter::app

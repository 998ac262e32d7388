#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands.h"
#include "app/common/files.h"
#include "app/common/manifest.h"
#include "app/common/progress.h"
#include "app/common/signals.h"
#include "app/common/values.h"
#include "assets/files/file.h"
#include "assets/files/partial_file.h"
#include "skitter/error.h"
#include "skitter/evolve.h"
#include "skitter/rig_gaits.h"
#include "skitter/rig_setup.h"

namespace skitter::app {
namespace {

namespace fs = std::filesystem;
using EvolveClock = std::chrono::steady_clock;

constexpr uint64_t usualEvaluations = 1000000, mostEvaluations = 1000000000000;
constexpr double judgedSeconds = 20;
constexpr auto savedEvery = std::chrono::seconds(30);
constexpr double eliteBytes = 300;
constexpr uint64_t mostAdapted = 10000;

struct EvolveCommand {
  std::string rig = "spider", out, json;
  std::optional<std::string> device;
  std::optional<uint64_t> seed, batch;
  std::optional<double> dt;
  uint64_t evaluations = usualEvaluations;
  uint32_t adapt = 0;
  bool resume = false, force = false, quiet = false;

  bool isBuiltin() const { return rig == "spider"; }
  fs::path table() const {
    if (!out.empty()) return out;
    return isBuiltin() ? fs::path("spider.gaits.json") : gaitsOf(rig);
  }
  // Where the map is from which the search can go on.
  fs::path map() const { return table().replace_extension(".map.json"); }
};

void checkEvolve(const EvolveCommand& options) {
  if (options.table().extension() != ".json")
    throw inputError(
        fmt::format("--out is {}, expected a name that ends in .gaits.json", options.table().string()));
  const auto refuse = [&](const char* option, bool given) {
    if (given && options.resume)
      throw inputError(fmt::format("{} is told by {} with --resume", option, options.map().string()));
  };
  refuse("--seed", options.seed.has_value());
  refuse("--batch", options.batch.has_value());
  refuse("--dt", options.dt.has_value());
  refuse("--force", options.force);
  std::error_code ignored;
  if (!options.resume && !options.force && fs::exists(options.map(), ignored))
    throw inputError(
        fmt::format("{} exists: --resume goes on from it, --force begins anew", options.map().string()));
}

Files evolveFiles(const EvolveCommand& options) {
  Files files;
  if (!options.isBuiltin()) {
    files.reads("--rig", options.rig);
    files.reads("--rig", sidecarOf(options.rig));
  }
  files.replaces("--out", options.table(), options.isBuiltin() ? options.table() : gaitsOf(options.rig));
  files.replaces("the map of --out", options.map(), options.map());
  files.writes("--json", options.json);
  return files;
}

Evolution searchOf(Device& device, const Rig& rig, const EvolveCommand& options) {
  if (options.resume) {
    const std::vector<uint8_t> text = readFile(options.map());
    return Evolution(device, rig, std::string(text.begin(), text.end()), options.map().string());
  }
  EvolutionOptions asked;
  if (options.seed) asked.seed = *options.seed;
  if (options.batch) asked.batch = static_cast<uint32_t>(*options.batch);
  if (options.dt) asked.dt = static_cast<float>(*options.dt);
  return Evolution(device, rig, asked);
}

// Means over patterns of how gaits were judged.
struct MeanJudgement {
  double speed = 0, unstable = 0, margin = 0, slip = 0, reachError = 0;

  explicit MeanJudgement(const std::vector<GaitJudgement>& all) {
    for (const GaitJudgement& each : all) {
      const double share = 1 / static_cast<double>(all.size());
      speed += share * each.speed;
      unstable += share * each.unstable;
      margin += share * each.margin;
      slip += share * each.slip;
      reachError = std::max(reachError, each.reachError);
    }
  }
  nlohmann::ordered_json json() const {
    return {{"speed", speed},
            {"unstable", unstable},
            {"margin", margin},
            {"slip", slip},
            {"reachErrorMost", reachError}};
  }
};

struct Judged {
  std::vector<GaitJudgement> found, byRule;
};

// What a gait is worth by measure: the share of the wanted speed that it keeps, less what breaks stability.
double worthOf(const GaitJudgement& judged) {
  return std::clamp(judged.speed / double{Evolution::wantedSpeed}, 0.0, 1.0) * (1 - judged.unstable);
}

// Patterns that a table leaves out go by the rule, so it has only gaits that were judged better than the rule's.
std::vector<RigGait> tableOf(const Evolution& search, const std::optional<Judged>& judged) {
  std::vector<RigGait> gaits = search.gaits();
  if (!judged) return gaits;
  std::vector<RigGait> better;
  for (size_t i = 0; i < gaits.size(); ++i)
    if (worthOf(judged->found[i]) > worthOf(judged->byRule[i])) better.push_back(std::move(gaits[i]));
  return better;
}

nlohmann::ordered_json searchJson(const Evolution& search, const std::optional<Judged>& judged) {
  nlohmann::ordered_json json = {
      {"seed", search.options().seed},      {"batch", search.options().batch},
      {"dt", search.options().dt},          {"evaluations", search.evaluations()},
      {"secondsOfTrial", search.seconds()}, {"wantedSpeed", Evolution::wantedSpeed},
      {"patterns", search.patternCount()},  {"cells", search.cellCount()},
      {"filled", search.filledCount()}};
  if (judged) {
    json["judgedSeconds"] = judgedSeconds;
    json["judged"] = MeanJudgement(judged->found).json();
    json["judgedByRule"] = MeanJudgement(judged->byRule).json();
  }
  return json;
}

void writeTable(const EvolveCommand& options, const Rig& rig, const Evolution& search,
                const std::optional<Judged>& judged) {
  writeText(options.map(), search.map());
  writeText(options.table(), writeGaits(rig, tableOf(search, judged), searchJson(search, judged).dump()));
}

void printJudgement(const char* name, const std::vector<GaitJudgement>& all) {
  const MeanJudgement mean(all);
  fmt::print(
      "{:<14} {:.3f} leg lengths/s, unstable {:.1f} %, margin {:.3f}, slip {:.4f} a stance, reach error at "
      "most {:.4f}\n",
      name, mean.speed, 100 * mean.unstable, mean.margin, mean.slip, mean.reachError);
}

void printSearch(const Evolution& search, uint64_t done, double seconds) {
  fmt::print("evaluations    {} of {:.2f} s each, dt {:.4g} s", search.evaluations(), search.seconds(),
             search.options().dt);
  if (done > 0) fmt::print("; {:.0f} a second now", static_cast<double>(done) / seconds);
  fmt::print("\ncoverage       {} of {} cells ({:.1f} %), of {} patterns\n", search.filledCount(),
             search.cellCount(),
             100 * static_cast<double>(search.filledCount()) / static_cast<double>(search.cellCount()),
             search.patternCount());
}

// How creatures found a gait again that they were not told of.
struct AdaptationFigures {
  size_t creatures = 0, failed = 0;
  uint32_t median = 0, most = 0;  // trials of those who found one

  explicit AdaptationFigures(const std::vector<AdaptationReport>& reports) : creatures(reports.size()) {
    std::vector<uint32_t> trials;
    for (const AdaptationReport& report : reports)
      if (report.trials > 0) trials.push_back(report.trials);
    failed = creatures - trials.size();
    if (trials.empty()) return;
    std::ranges::sort(trials);
    median = trials[(trials.size() - 1) / 2];
    most = trials.back();
  }
  nlohmann::ordered_json json() const {
    return {{"creatures", creatures}, {"failed", failed}, {"trialsMedian", median}, {"trialsMost", most}};
  }
};

int evolve(const EvolveCommand& options) {
  checkEvolve(options);
  Files files = evolveFiles(options);
  files.check();
  std::atomic<uint64_t> saved = 0;
  const auto leave = [&] { return interruptedAfter(saved, options.evaluations, "evaluations"); };
  std::optional<StopDeadline> deadline(std::in_place, leave);
  const Rig rig = options.isBuiltin() ? spiderRig() : loadRig(options.rig);
  DeviceRequest request;
  request.device = options.device;
  Device device = Device::create(request);
  Evolution search = searchOf(device, rig, options);
  files.expect("the map of --out", eliteBytes * static_cast<double>(search.cellCount()));
  files.check();
  deadline.reset();

  saved = search.evaluations();
  const uint64_t before = search.evaluations();
  const EvolveClock::time_point start = EvolveClock::now();
  EvolveClock::time_point lastSaved = start;
  {
    Progress progress("evaluations", options.evaluations, options.quiet);
    while (search.evaluations() < options.evaluations && !stopRequested()) {
      {
        const StopDeadline whileTrying(leave);
        search.step();
      }
      progress.update(std::min(search.evaluations(), options.evaluations));
      if (EvolveClock::now() - lastSaved < savedEvery) continue;
      writeText(options.map(), search.map());
      saved = search.evaluations();
      lastSaved = EvolveClock::now();
    }
  }
  const double seconds = std::chrono::duration<double>(EvolveClock::now() - start).count();
  const uint64_t done = search.evaluations() - before;
  std::optional<Judged> judged;
  if (search.evaluations() >= options.evaluations) {
    writeText(options.map(), search.map());
    saved = search.evaluations();
    const StopDeadline whileJudging(leave);
    const std::vector<RigGait> gaits = search.gaits();
    judged = Judged{search.judge(gaits, judgedSeconds), search.judge(gaits, judgedSeconds, true)};
  }
  std::optional<AdaptationFigures> adapted;
  if (judged && options.adapt > 0) {
    const StopDeadline whileAdapting(leave);
    adapted.emplace(search.adapt(options.adapt, search.options().seed));
  }
  writeTable(options, rig, search, judged);
  if (!options.json.empty()) {
    nlohmann::ordered_json json = searchJson(search, judged);
    json["interrupted"] = !judged;
    json["evaluationsWanted"] = options.evaluations;
    json["evaluationsNow"] = done;
    json["seconds"] = seconds;
    if (adapted) json["adapted"] = adapted->json();
    Manifest manifest{.dt = double{search.options().dt}, .seed = search.options().seed};
    manifest.add(device.report());
    writeJson(options.json, json, manifest);
  }
  if (!judged) throw Interrupted(interruptedAfter(search.evaluations(), options.evaluations, "evaluations"));
  if (!options.quiet) {
    printSearch(search, done, seconds);
    printJudgement("found", judged->found);
    printJudgement("by rule", judged->byRule);
    if (adapted)
      fmt::print(
          "trial, error   {} of {} losses came to 90 % of the best gait known, in {} trials at the median, "
          "{} at most\n",
          adapted->creatures - adapted->failed, adapted->creatures, adapted->median, adapted->most);
    fmt::print("written        {} ({} gaits of {} patterns, the others go by the rule), {}\n",
               options.table().string(), tableOf(search, judged).size(), judged->found.size(),
               options.map().string());
  }
  return 0;
}

}  // namespace

void addEvolve(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<EvolveCommand>();
  CLI::App* command =
      app.add_subcommand("evolve", "Search for the gaits of a rig some of whose legs do not carry");
  command
      ->add_option("--rig", options->rig, "spider, a model with its sidecar beside it, or a sidecar [spider]")
      ->type_name("FILE");
  command
      ->add_option("--out", options->out,
                   "the table to write [NAME.gaits.json beside the rig, where it is read from]")
      ->type_name("X.gaits.json");
  command
      ->add_option_function<std::string>(
          "--evaluations",
          [options](const std::string& text) {
            options->evaluations = parseWhole("--evaluations", text, 1, mostEvaluations);
          },
          fmt::format("trials in all, rounded up to whole batches [{}]", usualEvaluations))
      ->type_name("N");
  command
      ->add_option_function<std::string>(
          "--seed",
          [options](const std::string& text) { options->seed = parseWhole("--seed", text, 0, UINT64_MAX); },
          "what all randomness is drawn from [1]")
      ->type_name("N");
  command
      ->add_option_function<std::string>(
          "--batch",
          [options](const std::string& text) {
            options->batch = parseWhole("--batch", text, 1, EvolutionOptions::maxBatch);
          },
          fmt::format("trials at a time; it changes what is found [{}]", EvolutionOptions{}.batch))
      ->type_name("N");
  command
      ->add_option_function<std::string>(
          "--dt",
          [options](const std::string& text) {
            options->dt =
                parseNumber("--dt", text, double{EvolutionOptions::minDt}, double{EvolutionOptions::maxDt});
          },
          "seconds per tick of a trial [1/60]")
      ->type_name("S");
  command
      ->add_option_function<std::string>(
          "--adapt",
          [options](const std::string& text) {
            options->adapt = static_cast<uint32_t>(parseWhole("--adapt", text, 1, mostAdapted));
          },
          "then so many creatures lose legs and are not told which, and find a gait by trial and error")
      ->type_name("N");
  command->add_flag("--resume", options->resume, "go on from the map beside the table");
  command->add_flag("--force", options->force, "begin anew, and write over a map that is there");
  command
      ->add_option_function<std::string>(
          "--device", [options](const std::string& text) { options->device = text; },
          "number or part of the name of the device (skitter info) [the best suitable]")
      ->type_name("NAME|INDEX");
  command->add_option("--json", options->json, "write the figures to a file")->type_name("FILE");
  command->add_flag("--quiet", options->quiet, "no figures on stdout, no progress on stderr");
  command->footer(
      "Ctrl-C ends it within a second and leaves the table and the map so far; a batch that takes longer is "
      "given "
      "up, and the map is then at most 30 s old. docs/evolve.md explains the search and its files.\n"
      "\n"
      "Examples:\n"
      "  skitter evolve --out spider.gaits.json\n"
      "  skitter evolve --rig crab.glb --evaluations 250000\n"
      "  skitter evolve --rig crab.glb --evaluations 2000000 --resume");
  command->callback([options, &chosen] { chosen = [options] { return evolve(*options); }; });
}

}  // namespace skitter::app

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
#include "app/evolve/judgement.h"
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
constexpr auto savedEvery = std::chrono::seconds(30);
constexpr double eliteBytes = 300;
constexpr uint64_t mostAdapted = 10000;

struct EvolveCommand {
  std::string rig = "spider", out, json;
  std::optional<std::string> device;
  std::optional<uint64_t> seed, batch, adaptSeed;
  std::optional<double> dt;
  uint64_t evaluations = usualEvaluations;
  uint32_t adapt = 0;
  bool resume = false, force = false, judge = false, quiet = false;

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

// The best gait of each pattern, how it walks, and how the rule's does; and those that are worth more.
struct Judged {
  std::vector<GaitJudgement> found, byRule;
  std::vector<RigGait> table;

  Judged(Device& device, const Rig& rig, const Evolution& search) : table(search.gaits()) {
    std::vector<uint32_t> patterns;
    for (const RigGait& gait : table) patterns.push_back(gait.idle);
    const auto walk = [&](std::vector<RigGait> gaits) {
      Rig walker = rig;
      walker.gaits = std::move(gaits);
      return judgeGaits(device, walker, patterns, judgedSeconds, search.options().dt);
    };
    found = walk(table);
    byRule = walk({});
    table = betterThanRule(table, found, byRule);
  }
  nlohmann::ordered_json json(const Rig& rig) const {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (size_t i = 0; i < found.size(); ++i)
      all.push_back({{"without", namesOf(rig, found[i].idle)},
                     {"found", app::jsonOf(found[i])},
                     {"byRule", app::jsonOf(byRule[i])}});
    return all;
  }
};

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
  writeText(options.table(),
            writeGaits(rig, judged ? judged->table : search.gaits(), searchJson(search, judged).dump()));
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
  // The median, of an even number the lower one, and the most.
  struct Spread {
    uint32_t median = 0, most = 0;

    explicit Spread(std::vector<uint32_t> all = {}) {
      if (all.empty()) return;
      std::ranges::sort(all);
      median = all[(all.size() - 1) / 2];
      most = all.back();
    }
  };
  size_t creatures = 0, failed = 0;
  Spread trials, used;  // up to 90 %, of those who found a gait; and until they stopped, of all

  explicit AdaptationFigures(const std::vector<AdaptationReport>& reports) : creatures(reports.size()) {
    std::vector<uint32_t> toFind, inAll;
    for (const AdaptationReport& report : reports) {
      if (report.trials > 0) toFind.push_back(report.trials);
      inAll.push_back(report.used);
    }
    failed = creatures - toFind.size();
    trials = Spread(std::move(toFind));
    used = Spread(std::move(inAll));
  }
  nlohmann::ordered_json json() const {
    return {{"creatures", creatures},    {"failed", failed},          {"trialsMedian", trials.median},
            {"trialsMost", trials.most}, {"usedMedian", used.median}, {"usedMost", used.most}};
  }
  std::string text() const {
    return fmt::format(
        "trial, error   {} of {} losses came to 90 % of the best gait known, in {} trials at the median, {} "
        "at "
        "most; all stopped after {} at the median, {} at most\n",
        creatures - failed, creatures, trials.median, trials.most, used.median, used.most);
  }
};

Rig rigFor(const EvolveCommand& options) { return options.isBuiltin() ? spiderRig() : loadRig(options.rig); }

Device deviceFor(const EvolveCommand& options) { return Device::create({.device = options.device}); }

// Judges the table that the rig has.
int judgeTable(const EvolveCommand& options) {
  Files files;
  if (!options.isBuiltin()) files.reads("--rig", options.rig);
  files.writes("--json", options.json);
  files.check();
  const Rig rig = rigFor(options);
  Device device = deviceFor(options);
  const float dt = static_cast<float>(options.dt.value_or(double{EvolutionOptions{}.dt}));
  std::optional<StopDeadline> whileJudging(std::in_place,
                                           [] { return interruptedAfter(0, 1, "judgements of a table"); });
  const TableReport report(device, rig, dt);
  whileJudging.reset();
  if (!options.json.empty()) {
    Manifest manifest{.dt = double{dt}};
    manifest.add(device.report());
    writeJson(options.json, report.json(), manifest);
  }
  if (!options.quiet) fmt::print("{}", report.text());
  return 0;
}

int evolve(const EvolveCommand& options) {
  if (options.judge) return judgeTable(options);
  checkEvolve(options);
  Files files = evolveFiles(options);
  files.check();
  std::atomic<uint64_t> saved = 0;
  const auto leave = [&] { return interruptedAfter(saved, options.evaluations, "evaluations"); };
  std::optional<StopDeadline> deadline(std::in_place, leave);
  const Rig rig = rigFor(options);
  Device device = deviceFor(options);
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
    judged.emplace(device, rig, search);
  }
  std::optional<AdaptationFigures> adapted;
  if (judged && options.adapt > 0) {
    const StopDeadline whileAdapting(leave);
    adapted.emplace(search.adapt(options.adapt, options.adaptSeed.value_or(search.options().seed)));
  }
  writeTable(options, rig, search, judged);
  if (!options.json.empty()) {
    nlohmann::ordered_json json = searchJson(search, judged);
    json["interrupted"] = !judged;
    json["evaluationsWanted"] = options.evaluations;
    json["evaluationsNow"] = done;
    json["seconds"] = seconds;
    if (judged) json["candidates"] = judged->json(rig);
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
    if (adapted) fmt::print("{}", adapted->text());
    fmt::print("written        {} ({} gaits of {} patterns, the others go by the rule), {}\n",
               options.table().string(), judged->table.size(), judged->found.size(), options.map().string());
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
  command
      ->add_option_function<std::string>(
          "--adapt-seed",
          [options](const std::string& text) {
            options->adaptSeed = parseWhole("--adapt-seed", text, 0, UINT64_MAX);
          },
          "what these losses are drawn from [the seed of the search]")
      ->type_name("N")
      ->needs(command->get_option("--adapt"));
  CLI::Option* judge = command->add_flag("--judge", options->judge,
                                         "search nothing: judge the table that the rig has, beside the rule");
  for (const char* searching : {"--out", "--evaluations", "--seed", "--batch", "--adapt", "--adapt-seed"})
    judge->excludes(command->get_option(searching));
  judge->excludes(command->add_flag("--resume", options->resume, "go on from the map beside the table"));
  judge->excludes(
      command->add_flag("--force", options->force, "begin anew, and write over a map that is there"));
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
      "  skitter evolve --rig crab.glb --evaluations 2000000 --resume\n"
      "  skitter evolve --rig crab.glb --judge --json figures.json");
  command->callback([options, &chosen] { chosen = [options] { return evolve(*options); }; });
}

}  // namespace skitter::app

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/common/files.h"
#include "app/common/manifest.h"
#include "app/common/progress.h"
#include "app/common/signals.h"
#include "app/common/staged_folder.h"
#include "app/common/values.h"
#include "assets/files/partial_file.h"
#include "experiments/other_work.h"
#include "experiments/report.h"
#include "skitter/error.h"

namespace skitter::app {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

constexpr uint64_t maxTrialTicks = 100000;
constexpr double minScale = 1e-6, maxScale = 1e6;  // as --scale of run

struct ReproduceOptions {
  std::string out = "reproduction";
  std::optional<std::string> device;
  std::vector<std::string> terrains;
  std::optional<uint64_t> frames;
  uint64_t seed = 1;
  bool quick = false, force = false, quiet = false;
  std::string command;  // as typed
};

// NAME=FILE[,SCALE]
TerrainFileChoice parseTerrain(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == text.size())
    throw inputError(fmt::format("--terrain is {}, expected NAME=FILE[,SCALE]", text));
  TerrainFileChoice choice{text.substr(0, equals), text.substr(equals + 1), {}};
  const std::string file = choice.file.string();
  const size_t comma = file.rfind(',');
  if (comma != std::string::npos) {
    choice.file = file.substr(0, comma);
    choice.scale = parseNumber("--terrain's scale", file.substr(comma + 1), minScale, maxScale);
  }
  return choice;
}

std::vector<TerrainFileChoice> terrainsOf(const ReproduceOptions& options) {
  std::vector<TerrainFileChoice> chosen;
  for (const std::string& text : options.terrains) chosen.push_back(parseTerrain(text));
  return chosen;
}

constexpr double reportBytes = 16 << 20;  // a full one has 6 MiB

bool isReport(const fs::path& name) {
  return name.extension() == ".html" || name.extension() == ".csv" ||
         (name.extension() == ".png" && name.string().starts_with("placement-"));
}

void checkFiles(const ReproduceOptions& options) {
  Files files;
  for (const TerrainFileChoice& terrain : terrainsOf(options)) files.reads("--terrain", terrain.file);
  files.fills("--out", options.out, isReport, options.force);
  files.expect("--out", reportBytes);
  files.check();
}

Settings settingsOf(const ReproduceOptions& options) {
  Settings settings = options.frames ? Settings::trial(static_cast<uint32_t>(*options.frames))
                                     : (options.quick ? Settings::quick() : Settings::full());
  settings.seed = options.seed;
  return settings;
}

Results measure(Device& device, const std::vector<Ground>& grounds, const Settings& settings, bool quiet) {
  Progress progress("all figures", quiet);
  Course course([&](double done) { progress.updateShare(done); }, [] { return stopRequested(); });
  try {
    return measureAll(device, grounds, settings, course);
  } catch (const experiments::Interrupted&) {
    throw app::Interrupted(StopDeadline::nothingWritten());
  }
}

int reproduce(const ReproduceOptions& options) {
  checkFiles(options);
  std::optional<StopDeadline> deadline(std::in_place);
  const Settings settings = settingsOf(options);
  const std::vector<Ground> grounds = allGrounds(terrainsOf(options));
  Device device = Device::create({.device = options.device});
  const OtherWork others;
  const Results results = measure(device, grounds, settings, options.quiet);

  const Setup setup = describeSetup(device.report(), settings, options.command, others.share());
  const std::vector<ReportFile> files = reportOf(results, settings, setup);
  deadline.reset();
  if (stopRequested()) throw app::Interrupted(StopDeadline::nothingWritten());
  Manifest manifest{.seed = settings.seed};
  manifest.add(device.report());
  StagedFolder out(options.out);
  for (const ReportFile& file : files) {
    const std::string before = file.name.ends_with(".csv") ? manifest.csvComment() : "";
    writeText(out.add(file.name), before + file.bytes);
  }
  out.commit();

  for (const Conclusion& c : conclusionsOf(results))
    fmt::print("{:<14} {}: {}\n", verdictOf(c), c.claim, c.measured);
  if (!setup.warning.empty()) fmt::print(stderr, "skitter: {}\n", setup.warning);
  fmt::print("written        {}, beside {} raw files\n", (fs::path(options.out) / "index.html").string(),
             files.size() - 1);
  return 0;
}

}  // namespace

void addReproduce(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<ReproduceOptions>();
  CLI::App* command = app.add_subcommand(
      "reproduce",
      "Measure again all that the dissertation shows: one HTML page, and the raw figures as CSV");
  command->add_option("--out", options->out, "folder for the page and its raw files [reproduction]")
      ->type_name("DIR");
  command
      ->add_option_function<std::string>(
          "--device", [options](const std::string& text) { options->device = text; },
          "number or part of the name of the device (skitter info) [the best suitable]")
      ->type_name("NAME|INDEX");
  command->add_flag("--quick", options->quick,
                    "fewer points, ticks and agents: two minutes instead of seven or more");
  command
      ->add_option("--terrain", options->terrains,
                   "one more ground for the table of fidelity, again and again; one that is named jacksboro "
                   "or everest "
                   "replaces the ground of that name [samples scaled to 0.5 m]")
      ->type_name("NAME=FILE[,SCALE]");
  command
      ->add_option_function<std::string>(
          "--seed",
          [options](const std::string& text) { options->seed = parseWhole("--seed", text, 0, UINT64_MAX); },
          "what all randomness is drawn from [1]")
      ->type_name("N");
  command
      ->add_option_function<std::string>(
          "--frames",
          [options](const std::string& text) {
            options->frames = parseWhole("--frames", text, 1, maxTrialTicks);
          },
          "a trial of at most so many ticks an experiment and very few agents: its figures mean nothing")
      ->type_name("N");
  command->add_flag("--force", options->force, "write into a folder that is not empty and no earlier run's");
  command->add_flag("--quiet", options->quiet, "no progress on stderr");
  command->footer(
      "Ctrl-C ends it within a second and leaves nothing behind. docs/reproduce.md tells what is measured "
      "and "
      "how.\n"
      "\n"
      "Examples:\n"
      "  skitter reproduce --quick\n"
      "  skitter reproduce --out figures --terrain hill=hill.png,0.1");
  command->callback([options, command, &chosen] {
    options->command = "skitter reproduce";
    for (const CLI::Option* option : command->get_options()) {
      if (option->count() == 0) continue;
      for (const std::string& value : option->results())
        options->command +=
            fmt::format(" {}{}", option->get_name(), option->get_expected_max() == 0 ? "" : " " + value);
    }
    chosen = [options] { return reproduce(*options); };
  });
}

}  // namespace skitter::app

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>

#include "commands.h"
#include "experiments/report.h"
#include "part_file.h"
#include "progress.h"
#include "signals.h"
#include "skitter/error.h"
#include "values.h"

namespace skitter::app {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

constexpr uint64_t maxTrialTicks = 100000;
constexpr double minScale = 1e-6, maxScale = 1e6;  // as --scale of run
constexpr uint64_t progressParts = 1000;

struct ReproduceOptions {
  std::string out = "reproduction";
  std::optional<std::string> device;
  std::vector<std::string> terrains;
  std::optional<uint64_t> frames;
  uint64_t seed = 1;
  bool quick = false, force = false, quiet = false;
  std::string command;  // as typed
};

// Where the terrains of this project's measurements lie, if they do: beside the checkout.
std::vector<TerrainFileChoice> foundTerrains() {
  std::vector<TerrainFileChoice> found;
  for (const auto& [name, file] :
       {std::pair{"jacksboro", "jacksboro_403x344.png"}, std::pair{"everest", "everest_513x513.png"}}) {
    const fs::path path = fs::path("..") / "shared" / "data" / "terrain" / file;
    std::error_code error;
    if (fs::is_regular_file(path, error)) found.push_back({name, path, {}});
  }
  return found;
}

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
  for (const TerrainFileChoice& found : foundTerrains()) {
    const auto named = [&](const TerrainFileChoice& choice) { return choice.name == found.name; };
    if (std::none_of(chosen.begin(), chosen.end(), named)) chosen.push_back(found);
  }
  return chosen;
}

void checkOut(const ReproduceOptions& options) {
  checkFolderTarget("--out", options.out);
  std::error_code error;
  if (!options.force && fs::is_directory(options.out, error) && !fs::is_empty(options.out, error))
    throw inputError(fmt::format("--out {}: is not empty; --force writes among what is there", options.out));
}

Settings settingsOf(const ReproduceOptions& options) {
  Settings settings = options.frames ? Settings::trial(static_cast<uint32_t>(*options.frames))
                                     : (options.quick ? Settings::quick() : Settings::full());
  settings.seed = options.seed;
  return settings;
}

Results measure(Device& device, const std::vector<Ground>& grounds, const Settings& settings, bool quiet) {
  Progress progress("thousandths", progressParts, quiet);
  const StopDeadline deadline;
  Course course([&](double done) { progress.update(static_cast<uint64_t>(done * progressParts)); },
                [] { return stopRequested(); });
  try {
    return measureAll(device, grounds, settings, course);
  } catch (const Interrupted&) {
    throw Error(Error::Kind::check, "interrupted; nothing is written");
  }
}

int reproduce(const ReproduceOptions& options) {
  checkOut(options);
  const Settings settings = settingsOf(options);
  const std::vector<Ground> grounds = allGrounds(terrainsOf(options));
  DeviceRequest request;
  request.device = options.device;
  Device device = Device::create(request);
  const Results results = measure(device, grounds, settings, options.quiet);

  const Setup setup = describeSetup(device.report(), settings, options.command);
  const std::vector<ReportFile> files = reportOf(results, settings, setup);
  fs::create_directories(options.out);
  // The page comes last: where it lies, all that it tells of lies beside it.
  for (const ReportFile& file : files) writeText(fs::path(options.out) / file.name, file.bytes);

  for (const Conclusion& c : conclusionsOf(results))
    fmt::print("{:<14} {}: {}\n", verdictOf(c), c.claim, c.measured);
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
      ->add_option(
          "--terrain", options->terrains,
          "one more ground for the table of fidelity, again and again; jacksboro and everest are taken from "
          "../shared/data/terrain if they lie there [samples scaled to 0.5 m]")
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
  command->add_flag("--force", options->force, "write into a folder that is not empty");
  command->add_flag("--quiet", options->quiet, "no progress on stderr");
  command->footer(
      "Ctrl-C ends it and leaves nothing behind (exit code 1). docs/reproduce.md tells what is measured and "
      "how.\n"
      "\n"
      "Examples:\n"
      "  skitter reproduce --quick\n"
      "  skitter reproduce --out figures --terrain volcano=volcano.png,0.1");
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

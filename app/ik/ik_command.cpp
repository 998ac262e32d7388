#include "skitter/ik.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands.h"
#include "app/common/files.h"
#include "app/common/manifest.h"
#include "app/common/progress.h"
#include "app/common/signals.h"
#include "app/common/values.h"
#include "app/ik/chain_options.h"
#include "app/ik/figures.h"
#include "app/ik/machine.h"
#include "app/ik/summary.h"
#include "app/ik/targets.h"
#include "assets/files/partial_file.h"
#include "skitter/error.h"

namespace skitter::app {
namespace {

constexpr uint64_t mostIterations = 10000, defaultSeed = 1;
constexpr double leastTolerance = 1e-9;
// Independent solves are done this many at a time: enough to fill a device, few enough to see them go on.
constexpr uint64_t solvesAtOnce = 262144, referenceSolvesAtOnce = 1024;

struct IkOptions {
  IkChainOptions chain;
  ik::Options solve;
  std::string targets;
  std::optional<uint32_t> chains;
  std::optional<uint64_t> rows, seed;
  std::optional<std::string> device;
  std::string out, rotations, json;
  bool quiet = false;
};

void checkOptions(const IkOptions& options) {
  const auto inVain = [](const char* flag, const char* why) {
    throw inputError(fmt::format("{} {}", flag, why));
  };
  if (options.rows && !options.targets.empty()) inVain("--rows", "is told by the file of --targets");
  if (options.rows && options.solve.start == ik::Start::rest) inVain("--rows", "needs --start previous");
  if (options.seed && !options.targets.empty()) inVain("--seed", "is of no use with --targets");
}

Files filesOf(const IkOptions& options) {
  Files files;
  files.reads("--targets", options.targets);
  files.writes("--out", options.out);
  files.writes("--rotations", options.rotations);
  files.writes("--json", options.json);
  return files;
}

IkTargets targetsOf(const IkOptions& options, const ik::Chain& chain) {
  const ik::Start start = options.solve.start;
  if (!options.targets.empty()) return readIkTargets(options.targets, options.chains, start);
  const uint64_t rows = start == ik::Start::rest ? 1 : options.rows.value_or(defaultIkRows);
  return makeIkTargets(options.chains.value_or(defaultIkChains), rows, start, chain.reach(),
                       options.seed.value_or(defaultSeed));
}

bool byReference(const IkOptions& options) { return options.device == "cpu"; }

// How many targets the solver is given at a time: a row where solves continue, else all in equal parts.
uint32_t lotSize(const IkOptions& options, const IkTargets& targets) {
  if (options.solve.start == ik::Start::previous) return targets.chains;
  const uint64_t atOnce = byReference(options) ? referenceSolvesAtOnce : solvesAtOnce;
  const uint64_t lots = (targets.count() + atOnce - 1) / atOnce;
  return static_cast<uint32_t>((targets.count() + lots - 1) / lots);
}

// A file of float32 values, where one is wanted.
class FloatFile {
 public:
  explicit FloatFile(const std::string& file) {
    if (!file.empty()) file_.emplace(file);
  }
  template <class T>
  void append(const std::vector<T>& values, size_t count) {
    if (file_) file_->write(std::as_bytes(std::span(values).first(count)));
  }
  void finish() {
    if (file_) file_->keep();
  }
  void discard() { file_.reset(); }

 private:
  std::optional<PartialFile> file_;
};

// Where the solves go. Without a lot there is nothing but the figures' file.
class IkOutputs {
 public:
  IkOutputs(const IkOptions& options, const IkSummary& summary, uint64_t wanted)
      : options_(options),
        summary_(summary),
        wanted_(wanted),
        figures_(summary.chain),
        joints_(options.out),
        rotations_(options.rotations) {
    if (options.targets.empty()) manifest_.seed = summary.seed;
  }

  void madeBy(const IkMachine& machine) {
    manifest_.device = machine.name();
    manifest_.driver = machine.driver();
  }
  const IkFigures& figures() const { return figures_; }
  // A lot of which `wanted` solves count; `figures` are those of all up to it.
  void append(const IkLot& lot, size_t wanted, const IkFigures& figures) {
    const size_t bones = summary_.chain.bones.size();
    joints_.append(lot.joints, wanted * (bones + 1));
    rotations_.append(lot.rotations, wanted * bones);
    figures_ = figures;
  }
  void finish() {
    const bool interrupted = figures_.solves() < wanted_;
    nlohmann::ordered_json json = {
        {"solves", figures_.solves()}, {"solvesWanted", wanted_}, {"interrupted", interrupted}};
    if (figures_.solves() > 0) {
      joints_.finish();
      rotations_.finish();
      json = summary_.json(figures_);
    } else {
      joints_.discard();
      rotations_.discard();
    }
    if (!options_.json.empty()) writeJson(options_.json, json, manifest_);
    if (!options_.quiet && figures_.solves() > 0) summary_.print(figures_);
  }

 private:
  const IkOptions& options_;
  const IkSummary& summary_;
  uint64_t wanted_;
  Manifest manifest_;
  IkFigures figures_;
  FloatFile joints_, rotations_;
};

// Solves what the targets hold, lot by lot.
void solveAll(IkMachine& machine, const IkTargets& targets, uint32_t atOnce, const IkOptions& options,
              const StopDeadline::Leave& leave, IkOutputs& outputs) {
  Progress progress("solves", targets.count(), options.quiet);
  std::vector<glm::vec3> lot(atOnce);
  IkFigures figures = outputs.figures();
  while (figures.solves() < targets.count() && !stopRequested()) {
    const auto wanted = static_cast<size_t>(std::min<uint64_t>(atOnce, targets.count() - figures.solves()));
    IkLot solved;
    {
      const StopDeadline deadline(std::ref(leave));
      targets.next(std::span(lot).first(wanted));
      std::fill(lot.begin() + static_cast<std::ptrdiff_t>(wanted), lot.end(), lot[wanted - 1]);
      if (figures.solves() == 0) machine.warmUp(lot);
      solved = machine.solve(lot);
      figures.add(std::span(lot).first(wanted), solved);
    }
    outputs.append(solved, wanted, figures);
    progress.update(figures.solves());
  }
}

// What the engine is asked to do: no automatic solver, no defaults.
ik::Options resolved(const IkOptions& options, const ik::Chain& chain) {
  ik::Options solve = options.solve;
  solve.solver = ik::solverFor(chain, solve);
  if (solve.iterations == 0) solve.iterations = ik::defaultIterations(chain, solve);
  solve.restPull = ik::restPullOf(chain, solve);
  solve.rotations = !options.rotations.empty();
  checkSolver(solve.solver, chain, options.chain);
  return solve;
}

int solveIk(const IkOptions& options) {
  checkOptions(options);
  Files files = filesOf(options);
  files.check();
  IkSummary summary;
  summary.chain = options.chain.chain();
  summary.rest = options.chain.rest;
  summary.limits = options.chain.limits + (options.chain.freeBase ? ", the first bone free" : "");
  summary.solve = resolved(options, summary.chain);
  summary.targets = options.targets;
  summary.seed = options.seed.value_or(defaultSeed);
  for (const std::string& file : {options.out, options.rotations, options.json}) {
    if (!file.empty()) summary.files.push_back(file);
  }
  const IkTargets targets = targetsOf(options, summary.chain);
  summary.chains = targets.chains;
  summary.rows = targets.rows;
  const auto solves = static_cast<double>(targets.count());
  const auto bones = static_cast<double>(summary.chain.bones.size());
  files.expect("--out", solves * 3 * (bones + 1) * sizeof(float));
  files.expect("--rotations", solves * 4 * bones * sizeof(float));
  files.check();

  IkOutputs outputs(options, summary, targets.count());
  const auto leave = [&] {
    outputs.finish();
    return interruptedAfter(outputs.figures().solves(), targets.count(), "solves");
  };
  std::optional<StopDeadline> deadline(std::in_place, leave);
  const uint32_t atOnce = lotSize(options, targets);
  const auto machine = byReference(options)
                           ? makeReferenceMachine(summary.chain, atOnce, summary.solve)
                           : makeDeviceMachine(options.device, summary.chain, atOnce, summary.solve);
  deadline.reset();
  summary.device = machine->name();
  outputs.madeBy(*machine);
  solveAll(*machine, targets, atOnce, options, leave, outputs);
  outputs.finish();
  if (outputs.figures().solves() < targets.count())
    throw Interrupted(interruptedAfter(outputs.figures().solves(), targets.count(), "solves"));
  return 0;
}

void addSolverTo(CLI::App& command, IkOptions& options) {
  command
      .add_option_function<std::string>(
          "--solver",
          [&options](const std::string& text) {
            options.solve.solver = parseNamed("--solver", text, allSolvers);
          },
          fmt::format("{} (docs/ik.md) [auto: stretch-align without limits, active-set within them]",
                      namesOf(allSolvers)))
      ->type_name("S");
  command
      .add_option_function<std::string>(
          "--start",
          [&options](const std::string& text) {
            if (text != "rest" && text != "previous") {
              throw inputError(fmt::format("--start is {}, expected rest or previous", text));
            }
            options.solve.start = text == "rest" ? ik::Start::rest : ik::Start::previous;
          },
          "where a solve starts: at the rest pose, or where the chain's solve of the row before ended [rest]")
      ->type_name("rest|previous");
  command
      .add_option_function<std::string>(
          "--tolerance",
          [&options](const std::string& text) {
            options.solve.tolerance = static_cast<float>(parseNumber("--tolerance", text, leastTolerance, 1));
          },
          "how near is near enough, as a share of the chain's length [0.0009]")
      ->type_name("T");
  command
      .add_option_function<std::string>(
          "--iterations",
          [&options](const std::string& text) {
            options.solve.iterations =
                static_cast<uint32_t>(parseWhole("--iterations", text, 1, mostIterations));
          },
          "of a solve, at most [20 without limits, 64 within them; 4 from the previous pose]")
      ->type_name("I");
  command
      .add_option_function<std::string>(
          "--rest-pull",
          [&options](const std::string& text) {
            options.solve.restPull = static_cast<float>(parseNumber("--rest-pull", text, 0, 1));
          },
          "of active-set: share of the angle from rest that an iteration near the target takes back [0; 0.02 "
          "from the previous pose where there are hinges]")
      ->type_name("P");
}

void addTargetsTo(CLI::App& command, IkOptions& options) {
  command
      .add_option(
          "--targets", options.targets,
          "little-endian float32 x, y, z, with the base at 0 [seeded ones within reach: 0.2 to 0.95 of "
          "the length from the base; with --start previous they move 0.02 of it a row]")
      ->type_name("FILE.f32");
  command
      .add_option_function<std::string>(
          "--chains",
          [&options](const std::string& text) {
            options.chains = static_cast<uint32_t>(parseWhole("--chains", text, 1, ik::Batch::maxChains));
          },
          fmt::format("chains; a file's targets are rows of one for each [{}; of a file, as many as its "
                      "targets, or with --start previous 1]",
                      defaultIkChains))
      ->type_name("N");
  command
      .add_option_function<std::string>(
          "--rows",
          [&options](const std::string& text) { options.rows = parseWhole("--rows", text, 1, mostIkRows); },
          fmt::format("rows of targets, with --start previous and without a file [{}]", defaultIkRows))
      ->type_name("R");
  command
      .add_option_function<std::string>(
          "--seed",
          [&options](const std::string& text) { options.seed = parseWhole("--seed", text, 0, UINT64_MAX); },
          fmt::format("what targets are drawn from [{}]", defaultSeed))
      ->type_name("N");
}

void addOutputsTo(CLI::App& command, IkOptions& options) {
  command
      .add_option("--out", options.out,
                  "write the joints: float32 x, y, z, base first, chain by chain, row by row")
      ->type_name("FILE.f32");
  command
      .add_option("--rotations", options.rotations,
                  "write each bone's rotation from rest: float32 quaternions x, y, z, w")
      ->type_name("FILE.f32");
  command.add_option("--json", options.json, "write the figures to a file")->type_name("FILE");
  command.add_flag("--quiet", options.quiet, "no table on stdout, no progress on stderr");
}

}  // namespace

void addIk(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<IkOptions>();
  CLI::App* command = app.add_subcommand(
      "ik", "Solve inverse kinematics of many equal chains, and judge the poses that come out");
  options->chain.addTo(*command);
  addSolverTo(*command, *options);
  addTargetsTo(*command, *options);
  command
      ->add_option_function<std::string>(
          "--device", [options](const std::string& text) { options->device = text; },
          "number or part of the name of the device (skitter info), or cpu: the reference in double "
          "precision "
          "[the best suitable]")
      ->type_name("NAME|INDEX|cpu");
  addOutputsTo(*command, *options);
  command->footer(
      "A target counts as solved within 0.001 of the chain's length. Errors, limits and lengths are judged "
      "in\n"
      "double precision from the joints that come out. The first Ctrl-C ends the run within a second and "
      "completes its files.\n"
      "\n"
      "Examples:\n"
      "  skitter ik --joints 5\n"
      "  skitter ik --joints 5 --limits cone:60 --free-base --json figures.json\n"
      "  skitter ik --joints 4 --limits hinge:0,0,1,-90,30 --chains 1000 --start previous --rows 50\n"
      "  skitter ik --bones 2,2,1 --limits ellipse:40,70,30,20 --targets targets.f32 --out joints.f32");
  command->callback([options, &chosen] { chosen = [options] { return solveIk(*options); }; });
}

}  // namespace skitter::app

// Batched inverse kinematics on a Vulkan device beside the same solvers on the CPU, in one run
// (docs/ik-report.md).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench/cpu_baseline/batch.h"
#include "bench/ik/caliko.h"
#include "bench/ik/dissertation_figures.h"
#include "bench/ik/machine.h"
#include "bench/ik/sweep.h"
#include "bench/ik/table1.h"
#include "skitter/error.h"
#include "skitter/ik.h"

namespace {

using namespace skitter;

struct Options {
  std::string device, json;
  uint32_t chains = 0;
  int repetitions = 0;
  bool quick = false, table1 = false;
  std::string rows, figures;
};

bench::SweepOptions sweepOptions(const Options& options) {
  bench::SweepOptions made;
  made.filter = options.rows;
  if (options.quick) {
    made.quick = true;
    made.repetitions = 3;
    made.leastSeconds = 0.01;
  }
  if (options.chains > 0) made.chains = options.chains;
  if (options.repetitions > 0) made.repetitions = options.repetitions;
  return made;
}

std::ofstream opened(const std::string& file) {
  std::ofstream out(file);
  if (!out) throw inputError(fmt::format("--json {}: cannot be written", file));
  return out;
}

// Exit code.
int sweep(Device& device, const Options& options, nlohmann::ordered_json& made) {
  const bench::SweepOptions settings = sweepOptions(options);
  fmt::print("chains        {} a batch, {} repetitions, interleaved; medians of {}\n\n", settings.chains,
             settings.repetitions,
             bench::isCpu(device.report()) ? "CPU time of all threads"
                                           : "wall time on the device, CPU time on the CPU");
  made["chains"] = settings.chains;
  made["repetitions"] = settings.repetitions;
  bench::Sweep swept = bench::runSweep(device, settings);
  if (swept.rows.empty()) throw inputError(fmt::format("--rows {}: no row has such a name", options.rows));
  made["rows"] = std::move(swept.rows);
  return swept.failed == 0 ? 0 : 1;
}

int run(const Options& options) {
  std::ofstream json;
  if (!options.json.empty()) json = opened(options.json);
  DeviceRequest request;
  if (!options.device.empty()) request.device = options.device;
  Device device = Device::create(request);
  fmt::print("{}", bench::machineLines(device.report(), baseline::buildDescription()));
  nlohmann::ordered_json made = bench::describeMachine(device.report());
  made["cpuOpponentBuild"] = baseline::buildDescription();
  int code = 0;
  if (options.table1) {
    made["table1"] = bench::runTable1(device, options.quick ? 20 : 1000);
    made["caliko"] = bench::runCaliko(options.quick ? 20 : 1000);
  }
  if (!options.figures.empty()) bench::writeDissertationFigures(device, options.figures, options.quick);
  if (!options.table1 && options.figures.empty()) code = sweep(device, options, made);
  if (json.is_open() && !(json << made.dump(1) << "\n"))
    throw inputError(fmt::format("--json {}: cannot be written", options.json));
  return code;
}

int fail(int code, const std::string& message) {
  std::fflush(stdout);
  fmt::print(stderr, "ik_bench: {}\n", message);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Solves per core-second of the device and of the CPU, judged before they are timed.",
               "ik_bench"};
  Options options;
  app.add_option("--device", options.device, "Vulkan device, by number or part of its name")
      ->type_name("NAME|INDEX");
  app.add_option("--json", options.json, "write all figures to a file")->type_name("FILE");
  app.add_flag("--quick", options.quick, "few rows, few repetitions");
  app.add_option("--rows", options.rows,
                 "only rows whose name holds each of these words, of a,b either: \"fabrik,ccd J10 cold\"")
      ->type_name("WORDS");
  app.add_option("--chains", options.chains, "chains a batch [20480]")
      ->check(CLI::Range(1u, ik::Batch::maxChains));
  app.add_option("--repetitions", options.repetitions, "of every measurement [7]")
      ->check(CLI::Range(1, 1000));
  app.add_flag("--table1", options.table1,
               "instead: Table 1 of the FABRIK paper, and Caliko's set-up by its own measure");
  app.add_option("--figures", options.figures,
                 "instead: the dissertation's Figures 3 to 5 as CSV files, for scripts/plots")
      ->type_name("DIR");
  app.footer(
      "Exit codes: 0 done, 1 results that do not hold, 2 wrong usage or a debug build, 3 no usable device.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& wanted) {
    return app.exit(wanted);
  } catch (const CLI::ParseError& error) {
    return fail(2, error.what());
  }
#if defined(SKITTER_DEBUG_BUILD)
  return fail(2, "this is a debug build; configure with CMAKE_BUILD_TYPE=RelWithDebInfo");
#endif
  try {
    return run(options);
  } catch (const Error& error) {
    return fail(int(error.kind()), error.what());
  } catch (const std::exception& error) {
    return fail(3, error.what());
  }
}

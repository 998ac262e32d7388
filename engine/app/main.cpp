#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <new>
#include <string>

#include "commands.h"
#include "signals.h"
#include "skitter/error.h"

namespace {

constexpr const char* footer =
    "Exit codes: 0 done or passed, 1 a check failed, 2 wrong usage or input, 3 no usable device.\n"
    "\n"
    "Examples:\n"
    "  skitter info\n"
    "  skitter run\n"
    "  skitter rig crab.glb && skitter run --rig crab.glb\n"
    "  skitter run --agents 200 --frames 240 --out walk.mp4\n"
    "  skitter ik --joints 5 --limits cone:60\n"
    "  skitter validate --device llvmpipe\n"
    "  skitter reproduce --quick --out figures";

#if defined(SKITTER_BENCH)
constexpr const char* subcommands = "bench, ik, info, inspect, reproduce, rig, run or validate";
#else
constexpr const char* subcommands = "ik, info, inspect, rig, run or validate";
#endif

int fail(int code, std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::fflush(stdout);
  fmt::print(stderr, "skitter: {}\n", message);
  return code;
}

int runCommand(int argc, char** argv) {
  CLI::App app{"Skitter animates crowds of spiders on terrain with Vulkan compute shaders.", "skitter"};
  app.set_version_flag("--version", "skitter " SKITTER_VERSION);
  app.footer(footer);
  app.require_subcommand(0, 1);
  skitter::app::Command command;
#if defined(SKITTER_BENCH)
  skitter::app::addBench(app, command);
#endif
  skitter::app::addIk(app, command);
  skitter::app::addInfo(app, command);
  skitter::app::addInspect(app, command);
#if defined(SKITTER_BENCH)
  skitter::app::addReproduce(app, command);
#endif
  skitter::app::addRig(app, command);
  skitter::app::addRun(app, command);
  skitter::app::addValidate(app, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& wanted) {
    return app.exit(wanted);
  } catch (const CLI::ParseError& error) {
    return fail(2, fmt::format("{} (skitter --help lists what there is)", error.what()));
  }
  if (!command) return fail(2, fmt::format("no subcommand, expected {} (skitter --help)", subcommands));
  return command();
}

}  // namespace

int main(int argc, char** argv) {
  skitter::app::catchSignals();
  try {
    return runCommand(argc, argv);
  } catch (const skitter::Error& error) {
    return fail(static_cast<int>(error.kind()), error.what());
  } catch (const std::bad_alloc&) {
    return fail(2, "out of memory");
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(2, fmt::format("{}: {}", error.path1().string(), error.code().message()));
  } catch (const std::exception& error) {
    return fail(3, error.what());
  }
}

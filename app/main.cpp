#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "app/commands.h"
#include "app/common/manifest.h"
#include "app/common/signals.h"
#include "assets/files/partial_file.h"
#include "skitter/error.h"

namespace {

constexpr const char* exitCodes =
    "Exit codes: 0 done or passed, 1 a check failed, 2 wrong usage or input, or output that cannot be "
    "written, "
    "3 no usable device, 130 interrupted by Ctrl-C, SIGTERM or SIGHUP.\n"
    "\n";

constexpr const char* footer =
    "Examples:\n"
    "  skitter info\n"
    "  skitter run\n"
    "  skitter rig crab.glb && skitter run --rig crab.glb\n"
    "  skitter run --agents 200 --frames 240 --out walk.mp4\n"
    "  skitter ik --joints 5 --limits cone:60\n"
    "  skitter validate --device llvmpipe\n"
    "  skitter reproduce --quick --out figures";

int fail(int code, std::string message) {
  skitter::app::awaitKill();
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::fflush(stdout);
  std::fputs(("skitter: " + message + "\n").c_str(), stderr);
  return code;
}

// A closed standard stream's number would go to the next file that is opened, and what is printed into that.
void fillStandardStreams() {
  while (true) {
    const int number = open("/dev/null", O_RDWR);
    if (number > STDERR_FILENO) {
      close(number);
      return;
    }
    if (number < 0) return;
  }
}

// The error is 0 where it was lost on the way.
int unprintable(int error) {
  return fail(2, fmt::format("standard output: cannot be written: {}",
                             error != 0 ? skitter::writeFault(error) : "the disk may be full"));
}

// Text counts as written only once it has left the buffer.
int printed(int code) {
  errno = 0;
  std::cout.flush();
  const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
  return failed ? unprintable(errno) : code;
}

// A name that is "" is an unset variable in somebody's script, and no wish for nothing.
void refuseEmptyValues(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    for (const std::string& value : option->results())
      if (value.empty())
        throw skitter::inputError(
            fmt::format("{} is empty, expected {}", option->get_name(), option->get_type_name()));
}

int runCommand(int argc, char** argv) {
  CLI::App app{"Skitter animates crowds of legged creatures on terrain with Vulkan compute shaders.",
               "skitter"};
  app.set_version_flag("--version", std::string("skitter ") + skitter::app::version);
  app.footer(std::string(exitCodes) + footer);
  app.require_subcommand(0, 1);
  skitter::app::Command command;
#define ADD(Name) skitter::app::add##Name(app, command);
  SKITTER_COMMANDS(ADD)
#undef ADD
  std::vector<std::string> names;
  for (CLI::App* each : app.get_subcommands([](const CLI::App*) { return true; })) {
    each->footer(exitCodes + each->get_footer());
    names.push_back(each->get_name());
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& wanted) {
    return app.exit(wanted);
  } catch (const CLI::ParseError& error) {
    return fail(2, fmt::format("{} (skitter --help lists what there is)", error.what()));
  }
  for (const CLI::App* chosen : app.get_subcommands()) refuseEmptyValues(*chosen);
  if (!command)
    return fail(2, fmt::format("no subcommand, expected one of {} (skitter --help)", fmt::join(names, ", ")));
  return command();
}

}  // namespace

int main(int argc, char** argv) {
  fillStandardStreams();
  skitter::app::catchSignals();
  try {
    return printed(runCommand(argc, argv));
  } catch (const skitter::app::Interrupted& interrupted) {
    return fail(skitter::app::stopCode(), interrupted.what());
  } catch (const skitter::Error& error) {
    return fail(static_cast<int>(error.kind()), error.what());
  } catch (const std::bad_alloc&) {
    return fail(2, "out of memory");
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(2, fmt::format("{}: {}", error.path1().string(), error.code().message()));
  } catch (const std::system_error& error) {
    if (std::ferror(stdout) != 0) return unprintable(error.code().value());
    return fail(3, error.what());
  } catch (const std::exception& error) {
    return fail(3, error.what());
  }
}

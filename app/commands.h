#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace skitter::app {

// The subcommand that the command line names, run once all of it has been read; it returns the exit code.
using Command = std::function<int()>;

// Every subcommand, in the order in which --help lists them: COMMAND(NAME), added by addNAME. Those of
// SKITTER_WHERE_BENCH exist only where the opponents in bench/ are built.
#if defined(SKITTER_BENCH)
#define SKITTER_WHERE_BENCH(command) command
#else
#define SKITTER_WHERE_BENCH(command)
#endif
// clang-format off
#define SKITTER_COMMANDS(COMMAND) \
  SKITTER_WHERE_BENCH(COMMAND(Bench)) \
  COMMAND(Colony) \
  COMMAND(Fields) \
  COMMAND(Ik) \
  COMMAND(Info) \
  COMMAND(Inspect) \
  SKITTER_WHERE_BENCH(COMMAND(Reproduce)) \
  COMMAND(Rig) \
  COMMAND(Run) \
  COMMAND(Validate)
// clang-format on

// Each adds its subcommand, which sets `chosen` when the command line names it.
#define SKITTER_ADD(Name) void add##Name(CLI::App&, Command& chosen);
SKITTER_COMMANDS(SKITTER_ADD)
#undef SKITTER_ADD

}  // namespace skitter::app

#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace skitter::app {

// The subcommand that the command line names, run once all of it has been read; it returns the exit code.
using Command = std::function<int()>;

// Each adds its subcommand, which on being named sets `chosen`.
void addBench(CLI::App&, Command& chosen);  // where the opponents are built, as reproduce
void addIk(CLI::App&, Command& chosen);
void addInfo(CLI::App&, Command& chosen);
void addInspect(CLI::App&, Command& chosen);
void addReproduce(CLI::App&, Command& chosen);
void addRig(CLI::App&, Command& chosen);
void addRun(CLI::App&, Command& chosen);
void addValidate(CLI::App&, Command& chosen);

}  // namespace skitter::app

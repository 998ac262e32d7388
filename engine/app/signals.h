#pragma once

namespace skitter::app {

// From here on the first Ctrl-C (or SIGTERM) only asks for an end; a second one kills.
void catchSignals();
bool stopRequested();

// While it lives, a stop that is not followed within a second ends the process with exit code 1: what a
// device was given cannot be taken back, and may keep it for much longer. For work that has written nothing
// yet.
class StopDeadline {
 public:
  StopDeadline();
  ~StopDeadline();
  StopDeadline(const StopDeadline&) = delete;
  StopDeadline& operator=(const StopDeadline&) = delete;
};

}  // namespace skitter::app

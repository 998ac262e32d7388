#pragma once

namespace skitter::app {

// From here on the first Ctrl-C (or SIGTERM) only asks for an end; a second one kills.
void catchSignals();
bool stopRequested();

}  // namespace skitter::app

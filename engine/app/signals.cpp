#include "signals.h"

#include <csignal>

namespace skitter::app {
namespace {

volatile std::sig_atomic_t stop = 0;

void requestStop(int) { stop = 1; }

}  // namespace

void catchSignals() {
  struct sigaction action {};
  action.sa_handler = &requestStop;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool stopRequested() { return stop != 0; }

}  // namespace skitter::app

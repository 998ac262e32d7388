#include "signals.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <string_view>

namespace skitter::app {
namespace {

constexpr unsigned patience = 1;  // seconds

volatile std::sig_atomic_t stop = 0, deadline = 0;

void requestStop(int) {
  stop = 1;
  if (deadline != 0) alarm(patience);
}

void say(std::string_view text) {
  if (write(STDERR_FILENO, text.data(), text.size()) < 0) _exit(1);
}

void leave(int) {
  if (isatty(STDERR_FILENO) == 1) say("\r\x1b[K");  // the progress
  say("skitter: interrupted; nothing is written\n");
  _exit(1);
}

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

StopDeadline::StopDeadline() {
  std::fflush(stdout);  // which leave() cannot
  std::signal(SIGALRM, &leave);
  deadline = 1;
  if (stop != 0) alarm(patience);
}

StopDeadline::~StopDeadline() {
  deadline = 0;
  alarm(0);
}

}  // namespace skitter::app

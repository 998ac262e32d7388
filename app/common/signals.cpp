#include "app/common/signals.h"

#include <fmt/format.h>
#include <semaphore.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <mutex>
#include <thread>
#include <utility>

#include "render/child.h"

namespace skitter::app {
namespace {

using Clock = std::chrono::steady_clock;

// Together less than a second, which is what a user is promised; the kernel takes the rest of it to free the
// memory of a large crowd. Work that begins when the stop is long known, as a run's summary, gets
// `leastWork`.
constexpr std::chrono::milliseconds patience{500}, leastWork{200};
constexpr double together = 0.1;  // seconds

volatile std::sig_atomic_t stop = 0, killed = 0;
timespec first{};  // when `stop` was set
sem_t stopped;
std::atomic<bool> timeIsOver = false;

void requestStop(int signal) {
  const int error = errno;
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const auto seconds = static_cast<double>(now.tv_sec - first.tv_sec) +
                       1e-9 * static_cast<double>(now.tv_nsec - first.tv_nsec);
  // Signals are blocked in here, so this one takes effect on return.
  if (stop != 0 && seconds > together) {
    killed = 1;
    render::killChildren();
    std::signal(signal, SIG_DFL);
    raise(signal);
  } else if (stop == 0) {
    first = now;
    stop = 1;
    sem_post(&stopped);
  }
  errno = error;
}

// What the watchdog looks at. It is never destroyed: the watchdog outlives main.
struct Watch {
  std::mutex mutex;
  std::condition_variable changed;
  const StopDeadline::Leave* leave = nullptr;  // of the deadline that lives
  Clock::time_point since;                     // it began
};
Watch& watch() {
  static Watch* one = new Watch;
  return *one;
}

// Holds the lock until the end, so that the work cannot go on.
[[noreturn]] void leaveNow(const StopDeadline::Leave& leave) {
  int code = stopCode();
  std::string message;
  try {
    message = leave();
  } catch (const std::exception& error) {
    message = error.what();
    code = 2;
  }
  std::fflush(stdout);
  message = fmt::format("{}skitter: {}\n", isatty(STDERR_FILENO) == 1 ? "\r\x1b[K" : "", message);
  std::fputs(message.c_str(), stderr);
  render::killChildren();
  _exit(code);
}

void watchForStop() {
  while (sem_wait(&stopped) != 0) {
  }
  Watch& w = watch();
  std::this_thread::sleep_for(patience);
  for (std::unique_lock lock(w.mutex);;) {
    w.changed.wait(lock, [&] { return w.leave != nullptr; });
    const Clock::time_point due = w.since + leastWork;
    if (Clock::now() >= due) leaveNow(*w.leave);
    w.changed.wait_until(lock, due);
  }
}

}  // namespace

std::string interruptedAfter(uint64_t done, uint64_t wanted, const char* what) {
  return fmt::format("{} after {} of {} {}", timedOut() ? "timed out" : "interrupted", done, wanted, what);
}

void catchSignals() {
  sem_init(&stopped, 0, 0);
  struct sigaction action {};
  action.sa_handler = &requestStop;
  action.sa_flags = SA_RESTART;
  sigfillset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction hangUp {};
  sigaction(SIGHUP, nullptr, &hangUp);
  if (hangUp.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);
  // The watchdog must not be the thread that a signal interrupts.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread(watchForStop).detach();
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

bool stopRequested() { return stop != 0 || timeIsOver; }

void stopAfter(double seconds) {
  std::thread([seconds] {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    if (stopRequested()) return;
    timeIsOver = true;
    sem_post(&stopped);
  }).detach();
}

bool timedOut() { return timeIsOver; }
int stopCode() { return timedOut() ? 1 : interruptedCode; }

void awaitKill() {
  while (killed != 0) pause();
}

StopDeadline::StopDeadline(Leave leave) : leave_(std::move(leave)) {
  const std::lock_guard lock(watch().mutex);
  watch().leave = &leave_;
  watch().since = Clock::now();
  watch().changed.notify_one();
}

StopDeadline::~StopDeadline() {
  const std::lock_guard lock(watch().mutex);
  watch().leave = nullptr;
}

std::string StopDeadline::nothingWritten() { return "interrupted; nothing is written"; }

}  // namespace skitter::app

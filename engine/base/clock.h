#pragma once

#include <ctime>

namespace skitter::base {

inline double secondsOf(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

inline double wallSeconds() { return secondsOf(CLOCK_MONOTONIC); }

// CPU time so far of this thread, and of all threads of this process: a software device's are among them.
inline double threadSeconds() { return secondsOf(CLOCK_THREAD_CPUTIME_ID); }
inline double processSeconds() { return secondsOf(CLOCK_PROCESS_CPUTIME_ID); }

// CPU time of the process, and time by the wall. On a machine with other users the first says what work
// costs, the second how long they kept it waiting.
struct Seconds {
  double cpu = 0, wall = 0;

  Seconds& operator+=(const Seconds& more) {
    cpu += more.cpu, wall += more.wall;
    return *this;
  }
};

template <typename Work>
Seconds timed(const Work& work) {
  const double cpu = processSeconds(), wall = wallSeconds();
  work();
  return {processSeconds() - cpu, wallSeconds() - wall};
}

}  // namespace skitter::base

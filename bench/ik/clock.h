#pragma once

#include <ctime>

namespace skitter::bench {

// Seconds of all threads of this process, and of the wall. On a machine with other users the first says what
// work costs, the second how long they kept it waiting.
struct Seconds {
  double cpu = 0, wall = 0;

  Seconds& operator+=(const Seconds& more) {
    cpu += more.cpu, wall += more.wall;
    return *this;
  }
};

inline double readClock(clockid_t clock) {
  timespec time;
  clock_gettime(clock, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

template <typename Work>
Seconds timed(const Work& work) {
  const double cpu = readClock(CLOCK_PROCESS_CPUTIME_ID), wall = readClock(CLOCK_MONOTONIC);
  work();
  return {readClock(CLOCK_PROCESS_CPUTIME_ID) - cpu, readClock(CLOCK_MONOTONIC) - wall};
}

}  // namespace skitter::bench

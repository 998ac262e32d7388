#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace skitter::app {

// How far a run is, on stderr: a bar that redraws itself on a terminal, else a line every few seconds.
class Progress {
 public:
  Progress(std::string what, uint64_t total, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(uint64_t done);

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  uint64_t total_;
  bool quiet_, terminal_, drawn_ = false;
  Clock::time_point start_, last_;
};

}  // namespace skitter::app

#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace skitter::app {

// How far a run is, on stderr: a bar that redraws itself on a terminal, else a line every few seconds.
class Progress {
 public:
  // Counts `total` things that `what` names. Without `total`, `what` is one piece of work, told by its share.
  Progress(std::string what, uint64_t total, bool quiet);
  Progress(std::string what, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(uint64_t done);
  void updateShare(double done);

 private:
  using Clock = std::chrono::steady_clock;
  bool isDue();
  void show(double share, const std::string& done);

  std::string what_;
  uint64_t total_;
  bool quiet_, terminal_ = false, drawn_ = false;
  Clock::time_point start_, last_;
};

}  // namespace skitter::app

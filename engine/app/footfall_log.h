#pragma once

#include <filesystem>

#include "part_file.h"
#include "skitter/crowd.h"

namespace skitter::app {

// Every touchdown of a run as a line of CSV: herd, agent, leg, tick, seconds, x, y, z, speed.
class FootfallLog {
 public:
  explicit FootfallLog(const std::filesystem::path& file);

  void append(const Crowd& crowd);  // of the last tick
  void finish() { file_.commit(); }
  uint64_t count() const { return count_; }

 private:
  PartFile file_;
  uint64_t count_ = 0;
};

}  // namespace skitter::app

#pragma once

#include <filesystem>

#include "app/common/manifest.h"
#include "assets/files/partial_file.h"
#include "skitter/crowd.h"

namespace skitter::app {

// About what the touchdowns of so many ticks take.
double footfallBytes(const Crowd& crowd, double dt, uint64_t ticks);

// Every touchdown of a run as a line of CSV: herd, agent, leg, tick, seconds, x, y, z, speed. The manifest is
// in front of them.
class FootfallLog {
 public:
  FootfallLog(const std::filesystem::path& file, const Manifest& manifest);

  void append(const Crowd& crowd);  // of the last tick
  void finish() { file_.keep(); }
  uint64_t count() const { return count_; }

 private:
  PartialFile file_;
  uint64_t count_ = 0;
};

}  // namespace skitter::app

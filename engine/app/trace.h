#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "npy.h"
#include "skitter/crowd.h"

namespace skitter::app {

// Writes what every agent did, tick by tick, as NumPy files for plots and outside checks (docs/trace.md).
class Trace {
 public:
  // `ticks` is what is expected, for the size: beyond 4 GiB it is refused without `force`, and always where
  // the disk has less. Throws Error(input).
  Trace(std::filesystem::path folder, const Crowd& crowd, const Scene& scene, double dt, uint64_t ticks,
        bool force);

  // The crowd's present state as the next entry.
  void append(const Crowd& crowd);
  // Names the files; without it none remains.
  void finish(const Crowd& crowd, const Heightfield& terrain);

 private:
  struct HerdFiles {
    uint32_t agents;
    NpyWriter joints, rotations, stance, body;
  };
  std::filesystem::path folder_;
  double dt_;
  uint64_t entries_ = 0;
  std::vector<HerdFiles> herds_;
};

}  // namespace skitter::app

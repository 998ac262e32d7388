#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "app/common/manifest.h"
#include "app/common/staged_folder.h"
#include "app/run/npy.h"
#include "crowd/damage.h"
#include "skitter/crowd.h"

namespace skitter::app {

// Writes what every agent did, tick by tick, as NumPy files for plots and outside checks (docs/trace.md).
class Trace {
 public:
  // Throws Error(input).
  Trace(const std::filesystem::path& folder, const Crowd& crowd, double dt);
  // What the files of so many ticks take.
  static double bytes(const Crowd& crowd, const Heightfield& terrain, uint64_t ticks);
  // Whether a trace may write a file or folder of this name.
  static bool claims(const std::filesystem::path& name);

  // The crowd's present state as the next entry.
  void append(const Crowd& crowd);
  // The files take the place of an earlier trace's, of which it returns the number; without it none remains.
  size_t finish(const Crowd& crowd, const Heightfield& terrain, const Manifest& manifest);

 private:
  // A leg that was hurt or healed just before a tick.
  struct LegEntry {
    uint64_t tick;
    uint32_t agent, leg, bone;  // the first bone that is lost
    LegState state;
  };
  // The agent carries this load from the tick on.
  struct LoadEntry {
    uint64_t tick;
    uint32_t agent;
    Load load;
  };
  struct HerdFiles {
    uint32_t agents;
    NpyWriter joints, rotations, stance, body;
    // These two say how each agent was at the last entry. They are empty for a herd that cannot be hurt.
    std::vector<crowd::Damage> damages = {};
    std::vector<Load> carried = {};
    std::vector<LegEntry> legs = {};
    std::vector<LoadEntry> loads = {};
  };
  void noteLegs(const HerdState& state, uint32_t legs, HerdFiles& herd) const;
  void noteLoads(const HerdState& state, HerdFiles& herd) const;
  StagedFolder folder_;
  double dt_;
  uint64_t firstTick_ = 1, entries_ = 0;
  std::vector<HerdFiles> herds_;
};

}  // namespace skitter::app

#pragma once

#include <cstdint>
#include <vector>

#include "crowd/herd.h"
#include "shared/parameters.h"
#include "skitter/crowd.h"

namespace skitter::crowd {

// Where agent i of n starts: the herd's spawn, goal and seed decide alone, so pages never change a crowd.
class Spawner {
 public:
  Spawner(const skitter::Herd& from, const Herd& herd, const Heightfield& terrain, uint64_t seed);

  // Appends the initial records of agents [first, first + count): standing at home, feet on the ground.
  void append(uint32_t first, uint32_t count, HerdState& state) const;

 private:
  struct Placement {
    float x, z, heading;
    float targetX, targetZ, otherX, otherZ;
  };
  Placement place(uint32_t agent) const;
  void pushDirections(size_t leg, std::vector<float>& chain) const;

  const skitter::Herd& herd_;
  const Rig& rig_;
  const ClipRecords& clips_;
  const KeyPoses& keyPoses_;
  const Heightfield& terrain_;
  const shared::Parameters& tuning_;
  uint64_t seed_;
  uint32_t lanes_ = 1, rows_ = 1;
  float laneSpacing_ = 1, rowSpacing_ = 1;
};

}  // namespace skitter::crowd

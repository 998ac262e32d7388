#pragma once

#include <cstdint>
#include <span>

#include "crowd/herd.h"
#include "shared/parameters.h"
#include "skitter/crowd.h"

namespace skitter::crowd {

// The records that a page's agents begin with, laid out as shaders/shared/records.h says; all others begin as
// zeros.
struct SpawnRecords {
  std::span<float> goal, body, gait, step, foot, chain, tip, play;
};

// Where agent i of n starts: the herd's spawn, goal and seed decide alone, so neither pages nor threads ever
// change a crowd.
class Spawner {
 public:
  Spawner(const skitter::Herd& from, const Herd& herd, const Heightfield& terrain, uint64_t seed);

  struct Placement {
    float x, z, heading;                     // world metres; radians from +z toward +x
    float targetX, targetZ, otherX, otherZ;  // of the goal, world metres
  };
  Placement place(uint32_t agent) const;

  // Agents [first, first + count), a page's, standing at home, feet on the ground; on all cores where there
  // are many.
  void write(uint32_t first, uint32_t count, const SpawnRecords& records) const;

 private:
  class Writer;
  void pushDirections(size_t leg, Writer& chain) const;
  // Of the page whose first agent that is, agents [from, to).
  void writeRun(uint32_t first, uint32_t from, uint32_t to, const SpawnRecords& records) const;

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

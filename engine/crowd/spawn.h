#pragma once

#include <cstdint>
#include <span>

#include "crowd/herd.h"
#include "shared/parameters.h"
#include "skitter/crowd.h"

namespace skitter::crowd {

// Where the records go that a page's agents begin with; empty where the page keeps none or they begin as
// zeros.
using SpawnRecords = ForRecords<std::span<float>>;

// What a herd draws its agents' places and phases by.
constexpr uint64_t seedOf(const Scene& scene, uint64_t herd) { return scene.seed + (herd << 32); }

// Which of a herd's places the agents of each of its sizes have. Each place draws its size, so that no size
// is more here than there.
class SpawnPlaces {
 public:
  explicit SpawnPlaces(const Scene& scene);

  // Of the herd's size of that number, in order; empty where the herd has at most one size: all places.
  std::span<const uint32_t> of(uint32_t herd, size_t size) const;
  uint32_t count(uint32_t herd, size_t size) const;

 private:
  struct Places {
    uint32_t agents;
    std::vector<std::vector<uint32_t>> ofSizes;
  };
  std::vector<Places> herds_;
};

// Where agent i of n starts: the herd's spawn, goal and seed decide alone, so neither pages nor threads ever
// change a crowd.
class Spawner {
 public:
  // For the agents of a run: those that have `places`, or all of the herd where it is empty.
  Spawner(const skitter::Herd& from, const Kind& kind, const Heightfield& terrain, uint64_t seed,
          std::span<const uint32_t> places = {});

  struct Placement {
    float x, z, heading;                     // world metres; radians from +z toward +x
    float targetX, targetZ, otherX, otherZ;  // of the goal, world metres
  };
  Placement place(uint32_t place) const;
  // Agents side by side: place i is in row i / lanes(), in lane i % lanes().
  uint32_t lanes() const { return lanes_; }

  // The run's agents [first, first + count), standing at home, feet on the ground, into a page's records from
  // the at-th on; on all cores where there are many.
  void write(uint32_t first, uint32_t count, uint32_t at, const SpawnRecords& records) const;

 private:
  class Writer;
  void pushDirections(size_t leg, Writer& chain) const;
  // Agents [first, first + count), on this core.
  void writeRun(uint32_t first, uint32_t count, uint32_t at, const SpawnRecords& records) const;

  const skitter::Herd& herd_;
  const Rig& rig_;
  const ClipRecords& clips_;
  const KeyPoses& keyPoses_;
  const Heightfield& terrain_;
  const shared::Parameters& tuning_;
  uint64_t seed_;
  std::span<const uint32_t> places_;
  uint32_t lanes_ = 1, rows_ = 1;
  float laneSpacing_ = 1, rowSpacing_ = 1;
};

}  // namespace skitter::crowd

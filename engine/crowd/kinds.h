#pragma once

#include <cstdint>
#include <vector>

#include "crowd/herd.h"
#include "skitter/rig.h"
#include "skitter/scene.h"

namespace skitter::crowd {

// The agents of a herd that have one size; without sizes all, of size 1.
struct SizedHerd {
  uint32_t herd = 0;  // of the scene
  size_t place = 0;   // of the size among the herd's
  float size = 1;
  uint32_t kind = 0;
};
// The kinds of a scene's herds, in the order of each one's first herd.
struct Kinds {
  std::vector<SizedHerd> herds = {};      // size after size
  std::vector<uint32_t> firstHerds = {};  // the first run of each kind
  std::vector<Rig> rigs = {};             // of each kind, at size 1
};

// Herds are of one kind where their size is equal, and all but agents, spawn, goal, phase and colours. Throws
// Error(input) where there are more than a device can serve, or a herd's tuning, sizes or phase are out of
// range.
Kinds kindsOf(const Scene& scene);
// With rigs that the caller made, one a herd, in place of those that the scene names.
Kinds kindsOf(const Scene& scene, std::vector<Rig> rigs);

}  // namespace skitter::crowd

#pragma once

#include <cstdint>
#include <vector>

#include "crowd/herd.h"
#include "skitter/rig.h"
#include "skitter/scene.h"

namespace skitter::crowd {

// Each has about ten pipelines. Mesa's software device keeps the machine code of 1024; with more it makes
// some anew in every tick, which then takes 20 times as long.
constexpr size_t mostKinds = 100;

// The kinds of a scene's herds, in the order of each one's first herd.
struct Kinds {
  std::vector<uint32_t> ofHerds;     // the kind of each herd
  std::vector<uint32_t> firstHerds;  // the first herd of each kind
  std::vector<Rig> rigs;             // of each kind
};

// Herds are of one kind where they are equal but for agents, spawn, goal, phase and colours. Throws
// Error(input) where there are more than a device can serve, or a herd's tuning is out of range.
Kinds kindsOf(const Scene& scene);
// With rigs that the caller made, one a herd, in place of those that the scene names. Throws Error(input) for
// another count of them, too.
Kinds kindsOf(const Scene& scene, std::vector<Rig> rigs);

}  // namespace skitter::crowd

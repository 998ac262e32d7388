#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "crowd/herd.h"
#include "skitter/rig.h"
#include "skitter/scene.h"

namespace skitter::crowd {

// Each has about ten pipelines. Mesa's software device keeps the machine code of 1024; with more it makes
// some anew in every tick, which then takes 20 times as long.
constexpr size_t mostKinds = 100;

// A herd's agents of one size.
struct SizedHerd {
  uint32_t herd = 0;  // of the scene
  float size = 1;
  uint32_t kind = 0;
};

// The kinds of a scene's herds, in the order of each one's first herd.
struct Kinds {
  std::vector<SizedHerd> herds;      // herd after herd, and of a herd size after size
  std::vector<uint32_t> firstHerds;  // the first of these of each kind
  std::vector<Rig> rigs;             // of each kind, at size 1
};

// Throws Error(input) where its tuning, sizes, spawn, goal, phase or colours are out of range, or its agents
// and reserve are more than a crowd can have; `what` is its name there.
void checkHerd(const skitter::Herd& herd, const std::string& what);
// Reads the file that the herd names, if it names one.
Rig rigOf(const skitter::Herd& herd);

// Herds are of one kind where their size is equal, and all but agents, spawn, goal, other sizes, phase and
// colours. Throws Error(input) where there are more than a device can serve, or checkHerd refuses one.
Kinds kindsOf(const Scene& scene);
// With rigs that the caller made, one a herd, in place of those that the scene names. Throws Error(input) for
// another count of them, too.
Kinds kindsOf(const Scene& scene, const std::vector<Rig>& rigs);

}  // namespace skitter::crowd

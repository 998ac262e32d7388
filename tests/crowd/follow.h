#pragma once

#include "crowd/simulation.h"
#include "validation/lockstep/lockstep.h"

namespace skitter::test {

// Runs `ticks` ticks of a crowd that has just begun in lock step with the reference, events of its scene
// among them, and expects that each passes.
inline void expectFollowed(Device& device, Crowd& crowd, const Scene& scene, int ticks) {
  validation::Lockstep lockstep(crowd, scene, kTick);
  for (int i = 0; i < ticks; ++i) {
    lockstep.begin();
    simulate(device, crowd, 1);
    lockstep.end();
  }
  expectAllPass(lockstep.results());
}

}  // namespace skitter::test

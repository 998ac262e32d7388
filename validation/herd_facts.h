#pragma once

#include "crowd/herd.h"
#include "validation/replay.h"

// Apart from replay.h, which does without a device.
namespace skitter::validation {

// Of a herd whose tick length is known: its parameters are complete only then. Refers to the herd's rig.
inline HerdFacts herdFacts(const crowd::Herd& herd, const Heightfield& terrain) {
  return {herd.rig, terrain,         herd.parameters, herd.rigRecords,
          herd.ik,  herd.controller, herd.clips,      herd.keyPoses};
}

}  // namespace skitter::validation

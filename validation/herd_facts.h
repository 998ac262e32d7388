#pragma once

#include "crowd/herd.h"
#include "validation/replay.h"

// Apart from replay.h, which does without a device.
namespace skitter::validation {

// The facts of a herd's kind. Call it once the tick length is known: the parameters are complete only then.
// The facts refer to the kind's rig.
inline HerdFacts herdFacts(const crowd::Kind& kind, const Heightfield& terrain) {
  return {kind.rig, terrain,         kind.parameters, kind.rigRecords,
          kind.ik,  kind.controller, kind.clips,      kind.keyPoses};
}

}  // namespace skitter::validation

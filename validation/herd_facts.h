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

// The same of a herd's agents that have one size, who are replayed by themselves.
inline HerdFacts herdFacts(const Crowd::Impl& crowd, const crowd::HerdRun& of) {
  HerdFacts facts = herdFacts(crowd.kinds[of.run->kind], crowd.terrain);
  facts.firstAgent = of.run->firstOfHerd;
  return facts;
}

}  // namespace skitter::validation

#pragma once

#include "cpu_reference/ik/chain.h"

namespace skitter::reference {

// What becomes of a joint that would leave its cone.
enum class OutOfCone {
  keep,  // it stays where it was before the pass, as the text says: bone lengths are then not kept
  edge,  // its bone is moved to the nearest edge of the cone
};

// One iteration of FABRIK with limits as Aristidou's dissertation words them: on positions alone, in both
// passes, each cone's axis told from the one neighbouring bone that the pass has just placed. Cones and free
// bones only. A target out of reach lays the chain straight toward it, limits or not.
void dissertation(OutOfCone then, const std::vector<BoneRest>& bones, const glm::dvec3& target,
                  Joints& joints);

}  // namespace skitter::reference

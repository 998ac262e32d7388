#pragma once

#include "cpu_reference/arithmetic.h"
#include "cpu_reference/ik/chain.h"

namespace skitter::reference {

// One iteration of FABRIK (Aristidou & Lasenby 2011) toward `target`: tip to base from the target, then base
// to tip; with limits in the second pass, where the frames are known that they are told in. The tip may end
// up further away than it was.
void fabrik(const std::vector<BoneRest>& bones, const glm::dvec3& target, Joints& joints);
void fabrik(const glm::dvec3& target, Posture& posture);
void fabrik(const glm::dvec3& target, Posture& posture, Arithmetic& arithmetic);

// Its halves: where the joints would be if the tip were at the target; and the joints laid toward those
// places from joints[0], which stays.
Joints tipToBase(const std::vector<BoneRest>& bones, const glm::dvec3& target, const Joints& joints);
void baseToTip(const std::vector<BoneRest>& bones, const Joints& proposed, Joints& joints);

}  // namespace skitter::reference

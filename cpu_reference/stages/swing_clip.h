#pragma once

#include "cpu_reference/clips/table.h"
#include "cpu_reference/types.h"

namespace skitter::reference {

// A leg as the clip has it.
struct ClipLeg {
  std::vector<glm::dvec3> joints;      // p_0 .. p_bones, model space
  std::vector<glm::dvec2> directions;  // stereographic, whether the limits allow them or not
  // The divisors of each direction's d.x and d.y: how near it is to straight back.
  std::vector<double> divisors;
  bool stands = false;
};
ClipLeg clipLeg(const ClipTable& table, const Limb& limb, size_t leg, const Play& play);

struct ClipFoot {
  Foot foot;
  Chain chain;
};
ClipFoot clipSwing(const ClipTable& table, const Limb& limb, size_t leg, const AgentBody& body,
                   const Play& play);

}  // namespace skitter::reference

#pragma once

#include <cmath>

#include "check_look.h"
#include "fuzz.h"
#include "skitter/rig.h"

namespace skitter::fuzz {

// What kernels take for granted of a rig.
inline void checkRig(const Rig& rig) {
  const auto finite = [](const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  expect(!rig.legs.empty() && rig.legs.size() <= 24, "a rig without legs or with over 24");
  expect(std::isfinite(rig.legLength) && rig.legLength > 0, "a rig without a leg length");
  for (const Leg& leg : rig.legs) {
    expect(!leg.bones.empty() && leg.bones.size() <= 15, "a leg without bones or with over 15");
    expect(leg.group >= 0 && leg.group < rig.groupCount(), "a leg of no group");
    expect(finite(leg.home) && std::isfinite(leg.reach) && leg.reach > 0, "a leg that reaches nowhere");
    for (const Bone& bone : leg.bones) {
      expect(finite(bone.start) && finite(bone.direction) && std::isfinite(bone.length) && bone.length > 0,
             "a bone without length or direction");
      expect(bone.coneHalfAngle >= 0 && bone.coneHalfAngle < 3.1416f, "a cone without angle");
    }
  }
  for (const SkinVertex& vertex : rig.vertices) {
    expect(finite(vertex.position) && finite(vertex.normal) && finite(vertex.colour),
           "a vertex that is not finite");
    for (int k = 0; k < 4; ++k) {
      expect(vertex.bones[k] < rig.paletteSize(), "a vertex of no bone");
      expect(vertex.weights[k] >= 0 && vertex.weights[k] <= 1.001f, "a weight out of range");
    }
  }
  for (const uint32_t index : rig.indices) expect(index < rig.vertices.size(), "an index of no vertex");
  checkLook(rig.look, rig.vertices.size());
}

}  // namespace skitter::fuzz

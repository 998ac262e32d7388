#pragma once

#include <cmath>

#include "check_look.h"
#include "fuzz.h"
#include "skitter/clip.h"

namespace skitter::fuzz {

// What kernels take for granted of clips.
inline void checkClips(const ClipSet& set) {
  expect(!set.joints.empty() && set.joints.size() <= ClipSet::maxJoints,
         "a palette of no joints or too many");
  for (const SkinVertex& vertex : set.vertices) {
    for (int k = 0; k < 4; ++k) {
      expect(vertex.bones[k] < set.joints.size(), "a vertex of no joint");
      expect(vertex.weights[k] >= 0 && vertex.weights[k] <= 1.001f, "a weight out of range");
      if (k < 3)
        expect(std::isfinite(vertex.position[k]) && std::isfinite(vertex.normal[k]),
               "a vertex that is not finite");
    }
  }
  for (const uint32_t index : set.indices) expect(index < set.vertices.size(), "an index of no vertex");
  checkLook(set.look, set.vertices.size());
  for (const ClipLeg& leg : set.legs) {
    expect(leg.joints.size() == leg.starts.size() && leg.joints.size() >= 2, "a leg without bones");
    for (const uint16_t joint : leg.joints) expect(joint < set.joints.size(), "a leg of no joint");
  }
  for (const Clip& clip : set.clips) {
    expect(clip.frames() >= 1 && clip.frames() <= Clip::maxFrames, "a clip of no frames or too many");
    expect(clip.rows.size() == 3 * clip.frames() * set.joints.size(), "frames that are not whole");
    expect(clip.feet.size() == clip.frames() * set.legs.size() && clip.stance.size() == clip.feet.size(),
           "feet that are not of the legs");
    expect(clip.times.front() == 0 && clip.times.back() == static_cast<float>(clip.seconds),
           "times that are not the clip's");
    for (size_t f = 1; f < clip.frames(); ++f) expect(clip.times[f] >= clip.times[f - 1], "times that fall");
    for (const glm::vec4& row : clip.rows) {
      expect(std::isfinite(row.x) && std::isfinite(row.y) && std::isfinite(row.z) && std::isfinite(row.w),
             "a matrix that is not finite");
    }
    expect(clip.error <= 1e-4 * set.size, "an error over the bound");
    expect(std::isfinite(clip.speed) && std::isfinite(clip.ground), "a speed that is not finite");
  }
}

}  // namespace skitter::fuzz

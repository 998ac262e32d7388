#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace skitter::reference {

// Four columns of three: the last row of an affine matrix goes without saying.
using Affine = glm::dmat4x3;

// Clips as docs/clip.md bakes them. Frames count through all clips; heights are above each clip's own ground.
struct ClipTable {
  struct Clip {
    size_t firstFrame = 0, frames = 1;
    double seconds = 0;
    double speed = 0;  // m/s; 0: for standing
  };
  struct Frame {
    double time = 0;
    uint32_t standing = 0;  // bit l: leg l stands
  };
  // A joint of a leg: its place before skinning, and the palette's entry that moves it.
  struct LegJoint {
    glm::dvec3 start{0};
    size_t joint = 0;
  };
  // What turns an entry of the palette beside the clip; leg -1: nothing.
  struct BoneOf {
    int leg = -1, bone = 0;
  };

  std::vector<Clip> clips;
  std::vector<Frame> frames;
  std::vector<Affine> matrices;             // a frame, a joint
  std::vector<std::vector<LegJoint>> legs;  // bones + 1 each
  std::vector<BoneOf> bones;                // one a joint

  size_t joints() const { return bones.size(); }
  const Affine& matrix(size_t frame, size_t joint) const { return matrices[frame * joints() + joint]; }
};

// What an agent plays: two clips, of which the second fades.
struct Play {
  struct Played {
    int clip = 0;
    double time = 0, rate = 0;
    size_t frame = 0;     // the last one with t_f <= time
    double fraction = 0;  // of the way to the next
  };
  Played to, from;
  double weight = 1;  // of `to`
};

}  // namespace skitter::reference

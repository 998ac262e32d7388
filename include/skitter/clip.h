#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "skitter/export.h"
#include "skitter/material.h"
#include "skitter/rig.h"

namespace skitter {

// The animations of a model, baked to frames of skin matrices. docs/clip.md has every equation. All is in the
// rig's model space: metres, +Y up, the creature faces +Z, placed and sized as the rig is.

// One entry of a clip's palette: a node of the model that moves skin or is a joint of a leg.
struct ClipJoint {
  std::string name;  // the node's name, or #INDEX
  // The bone that moves it when a leg's bones are turned after the clip: the nearest leg joint that is this
  // node or above it. -1: none, it stays with the body. What hangs from a foot is of the last bone.
  int leg = -1, bone = -1;
};

// The chain of a leg of the rig, as the palette moves it: p_i = matrix[joints[i]] * starts[i].
struct ClipLeg {
  std::vector<uint16_t> joints;   // palette entries, one per bone, and that of the foot: bones + 1
  std::vector<glm::vec3> starts;  // p_0 .. p_bones, the last the foot, tip offset included, before skinning
};

// A clip of F + 1 frames. At time t, t_f <= t <= t_(f+1), a matrix is linear between frames f and f + 1; f is
// the last frame with t_f <= t. Two frames at one time are a jump.
struct Clip {
  std::string name;           // of the file, which may leave it empty or give it twice
  double seconds = 0;         // 0: a pose of one frame
  size_t channels = 0;        // of the file
  double error = 0;           // of the frames against exact sampling, metres; at most 1e-4 ClipSet::size
  glm::vec3 rootVelocity{0};  // m/s, y is 0: taken out of the frames; the agent moves so to give it back
  float speed = 0;   // m/s: the ground speed at which its stance feet stand still, negative backward; 0: idle
  float ground = 0;  // height of the stance feet in the clip: the ground, in model space
  glm::vec3 least{0}, most{0};  // a box that holds the skin all through the clip
  std::vector<float> times;     // ascending from 0 to seconds; 1 to maxFrames
  std::vector<glm::vec4> rows;  // [frame][joint][3]: rows of the 3x4 skin matrix
  std::vector<glm::vec3> feet;  // [frame][leg]
  std::vector<uint8_t> stance;  // [frame][leg], 1: the foot stands

  static constexpr size_t maxFrames = 4096;
  static constexpr double maxSeconds = 86400;

  size_t frames() const { return times.size(); }
};

// A model's skin, bound to all joints that it needs, and its clips.
struct SKITTER_API ClipSet {
  std::string name;                  // of the file, as messages give it
  double size = 0;                   // metres: the diagonal of the skin's box at rest
  std::vector<ClipJoint> joints;     // the palette, parents first; at most maxJoints
  std::vector<SkinVertex> vertices;  // where they were bound, mostly the rest pose; `bones` into `joints`
  std::vector<uint32_t> indices;     // as the rig's: triangles, counter-clockwise from outside
  Look look;                         // as the rig's, tangents as they were bound
  std::vector<ClipLeg> legs;         // as the rig's
  std::vector<Clip> clips;           // in the order of the file
  std::vector<std::string> notes;    // what was left out, a line each

  static constexpr size_t maxJoints = 1024;

  // Throws Error(input) that lists the clips there are. Of a name that is shared, the first.
  const Clip& clip(const std::string& clipName) const;
  // Those to go about with: clips that move forward, the slowest gait first, and one that stands. Names say
  // which: walk, trot, run, gallop and the like before all others, idle before others that stand, and never
  // an attack, a jump, a death and the like.
  std::vector<const Clip*> locomotion() const;
};

// A stretch of a clip that becomes a clip of its own: some files hold idle, walk and death in one take.
struct ClipCut {
  std::string clip;         // of the file, the first of that name
  std::string name;         // of the new one
  double from = 0, to = 0;  // seconds, 0 <= from < to <= the clip's

  bool operator==(const ClipCut&) const = default;
};

// The clips of a rig's file, a sidecar or a model, and after them the cuts. `rig` is what loadRig or
// proposedRig made of the same file. A model without legs is placed as it comes, for a Rig without legs. A
// clip that is faulty or takes over maxFrames is left out and named in `notes`. Throws Error(input) that
// names the file and the fault.
SKITTER_API ClipSet loadClips(const std::filesystem::path& file, const Rig& rig,
                              std::span<const ClipCut> cuts = {});
// The clips of the built-in spider: "walk" and "idle".
SKITTER_API ClipSet spiderClips();

// loadRig or, where a model has neither sidecar nor legs in its extras, the rig of its proposal
// (rig_setup.h). Throws Error(input) where no legs are found.
SKITTER_API Rig proposedRig(const std::filesystem::path& file);

}  // namespace skitter

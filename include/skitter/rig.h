#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "skitter/export.h"
#include "skitter/material.h"

namespace skitter {

// Everything here is in model space at rest: metres, +Y up, the creature faces +Z (so +X is its left), the
// origin on the ground below the body.

// One bone of a leg, from joint p_i to joint p_(i+1).
struct Bone {
  std::string joint;                  // the joint at its start
  glm::vec3 start{0};                 // p_i at rest
  glm::vec3 direction{0, 0, 1};       // r_i, unit, the rest direction
  float length = 0;                   // metres, > 0
  float coneHalfAngle = 3.14159265f;  // radians about r_i carried by R_(i-1); pi: unlimited

  bool operator==(const Bone&) const = default;
};

// One limb: the chain of bones from its root to its foot (the end effector).
struct Leg {
  static constexpr size_t maxBones = 15;

  std::string name;         // e.g. "L1"
  int group = 0;            // legs of one group swing together; two groups never do
  std::vector<Bone> bones;  // 1 to maxBones, root first
  glm::vec3 home{0};        // where the foot stands at rest
  float reach = 0;          // sum of the bone lengths

  const glm::vec3& root() const { return bones.front().start; }
  bool operator==(const Leg&) const = default;
};

struct SkinVertex {
  glm::vec3 position{0};
  glm::vec3 normal{0, 1, 0};
  glm::vec3 colour{1};               // linear RGB
  uint16_t bones[4] = {0, 0, 0, 0};  // into the pose palette: 0 the body, 1 + leg * maxBones + bone
  float weights[4] = {1, 0, 0, 0};   // sum to 1

  bool operator==(const SkinVertex&) const = default;
};

// A gait that was found for a pattern of legs that do not carry (docs/evolve.md). Lengths are leg lengths.
struct RigGait {
  struct Turn {
    float phase = 0;     // share of the cycle at which the leg's step may begin, 0 to less than 1
    float slowness = 1;  // how many times as long as others its step lasts, 0.5 to 2

    bool operator==(const Turn&) const = default;
  };
  static constexpr uint32_t maxGroups = 24;
  static constexpr float minSlowness = 0.5f, maxSlowness = 2, maxShift = 0.75f;

  uint32_t idle = 0;        // mask of the legs that do not carry
  uint32_t groups = 2;      // turns in a cycle, 1 to maxGroups
  bool adjacent = false;    // only the next legs around the body wait for a leg that is in the air, not all
  glm::vec3 shift{0};       // of the homes, each within maxShift; the body is lower by its y
  float speed = 1;          // share of the desired speed, more than 0, up to 1
  float fitness = 0;        // that it was found to have, 0 to 1
  std::vector<Turn> turns;  // one per leg of the rig; of legs that do not carry without a meaning

  bool operator==(const RigGait&) const = default;
};

// A skeleton, its skin, its legs and their limits; immutable once loaded.
struct SKITTER_API Rig {
  static constexpr size_t maxLegs = 24;

  std::string name;
  std::vector<Leg> legs;            // 1 to maxLegs
  std::vector<std::string> groups;  // group names, in the order in which they step
  float legLength = 1;              // the longest reach: the unit of every gait length
  float bodyHeight = 0;             // metres, centre of the body above the ground at rest
  float bodyRadius = 0;             // metres, half the body's length: what must clear the ground
  std::vector<SkinVertex> vertices;
  std::vector<uint32_t> indices;  // triangles, counter-clockwise from outside
  Look look;                      // of a model with textures and the like
  std::vector<RigGait> gaits;     // for patterns of legs that do not carry; others have one by rule

  int legCount() const { return static_cast<int>(legs.size()); }
  int groupCount() const { return static_cast<int>(groups.size()); }
  int maxBones() const;  // the longest chain; shorter ones are padded in the palette
  int paletteSize() const { return 1 + legCount() * maxBones(); }
  // Where the bone of each palette entry starts at rest; of padding, the leg's last bone.
  std::vector<glm::vec3> restStarts() const;
  bool operator==(const Rig&) const = default;
};

// A sidecar (NAME.rig.json); or a model (.glb, .gltf) with its sidecar beside it or, failing that, with legs
// in its extras (docs/rig.md); with the gaits of NAME.gaits.json, where that is beside it (docs/evolve.md).
// Throws Error(input) that names the file and the fault.
SKITTER_API Rig loadRig(const std::filesystem::path& file);
// A model whose extras hold the legs, everything in one file.
SKITTER_API Rig parseRig(std::span<const uint8_t> gltf, const std::string& name);
// The built-in spider (assets/spider.glb, embedded): eight legs of four bones, leg length 1 m.
SKITTER_API Rig spiderRig();

}  // namespace skitter

#pragma once

#include <cstdint>
#include <vector>

#include "bench/cpu_baseline/vector.h"
#include "validation/replay.h"

namespace skitter::cpu_crowd {

using baseline::Mat3;
using baseline::Vec3;

// Lengths are shares of the leg's reach.
struct BoneModel {
  Mat3<float> carry;                 // B_(i-1)^T B_i, of the first bone B_0
  Vec3<float> restX, restY, rest;    // columns of B_i
  float length, edge, stiffness;     // edge: tan(half-angle / 2)
  float inverseEdgeSquared, leastK;  // 1 / edge^2; 2 / (1 + edge^2), what k of a direction is at the edge
};

struct LegModel {
  Vec3<float> root, home;
  float reach, group, lag;
  uint32_t neighbours;
  std::vector<BoneModel> bones;  // without padding
};

struct Terrain {
  std::vector<float> heights;
  int columns, rows;
  float originX, originZ, inverseSpacingX, inverseSpacingZ;
};

struct alignas(64) Line {
  float at[16];
};

// The clips that agents play; a frame's matrices lie in three planes, a row of all joints each, so that an
// agent's are blended and turned as they lie.
struct ClipTable {
  struct Clip {
    float first, frames, seconds, speed;
  };
  std::vector<Clip> clips;
  bool standing = false;                // there is one that stands
  std::vector<float> times, perSecond;  // of frames; 1 / time to the next one
  int joints = 0;
  size_t lines = 0;  // a plane
  std::vector<Line> planes;

  const Line* frame(float f) const { return planes.data() + size_t(f) * 3 * lines; }
};

// What all agents share.
struct World {
  shared::Parameters q;
  Terrain terrain;
  std::vector<LegModel> legs;
  int bones;  // of the longest leg
  int groups, approach, chords;
  ClipTable clips;  // empty where none are played
};

// For a controller that plays clips, the parameters are those of a blind body (docs/stages/body.md). Throws
// Error(input) where the rig records' size does not fit the rig.
World worldOf(const validation::HerdFacts& facts);

}  // namespace skitter::cpu_crowd

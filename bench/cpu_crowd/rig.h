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

// What all agents share.
struct World {
  shared::Parameters q;
  Terrain terrain;
  std::vector<LegModel> legs;
  int bones;  // of the longest leg
  int groups, approach, chords;
};

// Throws Error(input) where the rig records' size does not fit the rig.
World worldOf(const validation::HerdFacts& facts);

}  // namespace skitter::cpu_crowd

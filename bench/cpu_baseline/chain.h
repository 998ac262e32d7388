#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "bench/cpu_baseline/rows.h"
#include "bench/cpu_baseline/vector.h"

namespace skitter::baseline {

inline constexpr int kMaxBones = 15;

enum class LimitKind { free, cone, ellipse, hinge };

// Angles in radians, all as docs/ik.md has them.
struct Limit {
  LimitKind kind = LimitKind::free;
  float cone = 3.1f;                                                 // half-angle
  float positiveX = 1, negativeX = 1, positiveY = 1, negativeY = 1;  // half-angles of the ellipse
  std::array<float, 3> axis{1, 0, 0};                                // of the hinge, unit
  float low = -3.1f, high = 3.1f;                                    // of the hinge
  float twistLow = 0, twistHigh = 0;                                 // of a ball
};

struct Bone {
  float length = 1;
  std::array<float, 3> rest{0, 0, 1};  // unit
  Limit limit;
};

// What the caller says: any unit of length, the base at 0.
struct Chain {
  std::vector<Bone> bones;
};

// n equal bones of total length 1, bone i at 60 - 140 i / (n - 1) degrees from X in the XY plane (at 60 if it
// is alone), all with the same limit. It is what the measurements are made with.
Chain bentChain(int bones, const Limit& limit = {});

// A bone as the solvers need it. Lengths are shares of the chain's.
struct BoneModel {
  float length = 0;
  bool turns = false;  // it has a length
  LimitKind kind = LimitKind::free;
  bool twists = false;
  bool wide = true;                // may turn beyond a right angle
  Mat3<float> carry{};             // B_(i-1)^T B_i, of the first bone B_0: A_i = F_(i-1) carry
  float offsetX = 0, offsetZ = 1;  // o_i = (offsetX, 0, offsetZ)
  float coneSine = 0, coneCosine = 0, coneTanHalf = 0;
  float inversePositiveX = 1, inverseNegativeX = 1, inversePositiveY = 1, inverseNegativeY = 1;
  float lowSine = 0, lowCosine = 1, lowTanHalf = 0, highSine = 0, highCosine = 1, highTanHalf = 0;
  float twistLowTanHalf = 0, twistHighTanHalf = 0;
};

// Where a chain of the model stands: swing (X, Y) and tan(twist / 2) of each bone.
struct Pose {
  std::array<float, kMaxBones> x{}, y{}, twist{};
};

// A chain made ready: what all chains of a batch share.
struct Model {
  int bones = 0;
  bool limited = false;
  std::array<BoneModel, kMaxBones> bone{};
  std::array<Vec3<float>, kMaxBones> restJoints{};  // p_1 .. p_n
  std::array<Vec3<double>, kMaxBones> restDirections{};

  // Start poses of the active set's restarts, limited chains only. The rows are joints p_1 .. p_n, three a
  // joint, and beyond them X, Y and tan(twist / 2), three a bone.
  static constexpr int kSeeds = 64;
  int seeds = 0;
  Rows seedRows;
  // The first bone turns freely: it is at rest in the seeds, which are shapes to be turned to their target,
  // and seedRows have |p_1| .. |p_n| after the rest.
  bool aimed = false;
  // The cube from -1 to 1 is cut into kCells cells each way, x first. Each cell has the seed whose tip is
  // nearest to its middle, or -1 where the tip at rest is nearer. For shapes, |target| from 0 to 1 is cut
  // into as many shells.
  static constexpr int kCells = 16;
  std::vector<int8_t> seedCells;

  // Where a cold solve of a target begins: a seed, or -1 for rest.
  int seedNear(const Vec3<float>& target) const {
    constexpr int kShells = kCells * kCells * kCells;
    if (aimed) {
      const float shell = std::sqrt(dot(target, target)) * kShells;
      return seedCells[int(std::min(shell, kShells - 1.0f))];
    }
    const auto cell = [](float x) { return int(std::clamp((x + 1) * (kCells / 2), 0.0f, kCells - 1.0f)); };
    return seedCells[cell(target.x) + kCells * (cell(target.y) + kCells * cell(target.z))];
  }

  Model() = default;
  // Throws std::invalid_argument for what docs/ik.md refuses.
  explicit Model(const Chain& chain);
};

// A pose whose every angle is drawn evenly from what its limit lets; scaled by `share` toward rest.
Pose randomPose(const Chain& chain, std::mt19937& random, double share = 1);

// p_1 .. p_n of a pose, in double and written on its own, by the forward kinematics of docs/ik.md; for making
// targets and for checking.
std::vector<Vec3<double>> jointsOf(const Chain& chain, const Pose& pose);

}  // namespace skitter::baseline

#pragma once

#include <optional>
#include <random>

#include "cpu_reference/ik/solve.h"

namespace skitter::test {

constexpr double degree = 0.017453292519943295;

// A bone as the page describes it, in angles, from which the chain is made and by which results are judged.
struct BoneSpec {
  double length = 1;
  glm::dvec3 direction{0, 0, 1};
  reference::LimitKind kind = reference::LimitKind::free;
  double cone = 0;                                 // radians, as all
  glm::dvec4 angles{0};                            // of an ellipse: toward +x, +y, -x, -y
  glm::dvec3 axis{0, 0, 1};                        // of a hinge, unit
  double low = 0, high = 0;                        // of a hinge
  std::optional<std::pair<double, double>> twist;  // low, high
};
using ChainSpec = std::vector<BoneSpec>;

reference::IkChain chainOf(const ChainSpec& spec, const std::optional<glm::dvec3>& pole = {});

// `bones` equal bones from 60 to -80 degrees in the XY plane.
ChainSpec bentSpec(size_t bones);
// The same with one limit for all.
ChainSpec coneSpec(size_t bones, double halfAngle);
ChainSpec ellipseSpec(size_t bones);  // 30, 70, 40, 20 degrees
ChainSpec hingeSpec(size_t bones);    // about Z, +-60 degrees; the first bone is free
// Every kind of limit, one with twist and a skew hinge, on bones of different lengths.
ChainSpec mixedSpec();

// What a chain of these bones would be wrong by, judged from the joints alone by angles: each bone's rotation
// is carried from the base as the page words it (the shortest arc; a hinge about its axis), and what that
// says of the bone is compared with its limit. Twist cannot be seen in joints, so a bone that has a range has
// its rotation from `rotations`.
struct Verdict {
  double beyond = 0;    // the worst limit violation, radians
  double stretch = 0;   // the worst bone length error, shares of the chain
  double rotation = 0;  // the worst difference of a rotation's bone from the joints'
};
Verdict judge(const ChainSpec& spec, const reference::Joints& joints,
              const std::vector<glm::dmat3>& rotations);

std::vector<glm::dmat3> rotationsOf(const reference::IkChain& chain, const reference::IkState& state);

// From rest, without memory.
reference::IkResult solve(const reference::IkChain&, const reference::IkSettings&, const glm::dvec3& target);

// Uniform in the shell of distances low to high.
glm::dvec3 randomPoint(std::mt19937_64& random, double low, double high);

}  // namespace skitter::test

#include "assets/rigs/joint_cones.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

namespace skitter {
namespace {

constexpr double leastCone = 45, mostCone = 120, rootCone = 60, rootMargin = 40, footCone = 45;  // degrees
constexpr double kneeBend = 15;     // degrees at rest: a joint that bends more has a side to which it bends
constexpr double tightFold = 0.45;  // of the reach: legs that fold so far walk without turning a knee over
constexpr double foldShare =
    0.25;  // of the reach, root to foot: gait lets feet come as near (crowd/tuning.cpp)
constexpr double inDegrees = 180 / std::numbers::pi;

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  const double lengths = glm::length(a) * glm::length(b);
  return lengths > 0 ? std::acos(std::clamp(glm::dot(a, b) / lengths, -1.0, 1.0)) * inDegrees : 0;
}

// The least distance from root to foot, a share of the reach, as every joint bends on the way it bends at
// rest.
double foldedSpan(const Leg& leg, const std::vector<double>& cones) {
  constexpr int steps = 12;
  double least = 1;
  for (int step = 1; step <= steps; ++step) {
    glm::dquat turn(1, 0, 0, 0);
    glm::dvec3 tip(0);
    for (size_t i = 0; i < leg.bones.size(); ++i) {
      const glm::dvec3 bone(leg.bones[i].direction);
      if (i > 0) {
        const glm::dvec3 axis = glm::cross(glm::dvec3(leg.bones[i - 1].direction), bone);
        const double angle = cones[i] / inDegrees * step / steps;
        if (glm::length(axis) > 1e-6) turn = turn * glm::angleAxis(angle, glm::normalize(axis));
      }
      tip += turn * bone * double{leg.bones[i].length};
    }
    least = std::min(least, glm::length(tip) / double{leg.reach});
  }
  return least;
}

}  // namespace

std::vector<double> conesOf(const Leg& leg, size_t footBones) {
  std::vector<double> cones;
  std::vector<bool> knees;
  for (size_t i = 0; i < leg.bones.size(); ++i) {
    const glm::dvec3 bone(leg.bones[i].direction);
    if (i == 0) {
      const double cone =
          std::max(rootCone, angleBetween(bone, glm::dvec3(leg.home - leg.root())) + rootMargin);
      cones.push_back(std::round(std::min(cone, mostCone)));
      knees.push_back(true);
      continue;
    }
    const double bend = angleBetween(glm::dvec3(leg.bones[i - 1].direction), bone);
    const bool foot = i + footBones >= leg.bones.size();
    knees.push_back(foot || bend > kneeBend);
    cones.push_back(foot ? footCone : bend > kneeBend ? std::floor(std::min(bend, mostCone)) : leastCone);
  }
  const auto widen = [&](bool all) {
    for (double widest = leastCone; widest < mostCone && foldedSpan(leg, cones) > foldShare; widest += 5) {
      for (size_t i = 1; i + footBones < cones.size(); ++i) {
        if (all || !knees[i]) cones[i] = std::max(cones[i], widest + 5);
      }
    }
  };
  widen(false);
  if (foldedSpan(leg, cones) > tightFold) widen(true);
  return cones;
}

}  // namespace skitter

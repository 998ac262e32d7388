#include "ik_chains.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace skitter::test {
namespace {

using reference::LimitKind;

glm::dmat3 about(const glm::dvec3& axis, double angle) { return glm::mat3_cast(glm::angleAxis(angle, axis)); }

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

glm::dmat3 shortestArc(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 axis = glm::cross(a, b);
  const double sine = glm::length(axis);
  return sine == 0 ? glm::dmat3(1) : about(axis / sine, angleBetween(a, b));
}

// Angle from a to b about `axis`.
double angleAbout(const glm::dvec3& axis, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 u = a - axis * glm::dot(a, axis), v = b - axis * glm::dot(b, axis);
  return std::atan2(glm::dot(axis, glm::cross(u, v)), glm::dot(u, v));
}

double outside(double value, double low, double high) { return std::max({0.0, low - value, value - high}); }

// How far v, the bone in the axes of the bone before it, is beyond a cone or ellipse.
double beyondSwing(const BoneSpec& bone, const glm::dvec3& v) {
  const glm::dvec3 rest = glm::normalize(bone.direction);
  const double theta = angleBetween(rest, v);
  if (bone.kind == LimitKind::free) return 0;
  if (bone.kind == LimitKind::cone) return std::max(0.0, theta - std::min(bone.cone, 3.1));
  const glm::dvec3 x = shortestArc({0, 0, 1}, rest) * glm::dvec3(1, 0, 0), y = glm::cross(rest, x);
  const double way = std::atan2(glm::dot(v, y), glm::dot(v, x));
  const double ax = std::cos(way) >= 0 ? bone.angles.x : bone.angles.z;
  const double ay = std::sin(way) >= 0 ? bone.angles.y : bone.angles.w;
  return std::max(0.0, theta - 1 / std::hypot(std::cos(way) / ax, std::sin(way) / ay));
}

}  // namespace

reference::IkChain chainOf(const ChainSpec& spec, const std::optional<glm::dvec3>& pole) {
  std::vector<reference::IkBone> bones;
  for (const BoneSpec& s : spec) {
    reference::IkBone bone{.length = s.length, .direction = s.direction, .hingeAxis = s.axis};
    if (s.kind == LimitKind::cone) bone.limit = reference::coneLimit(s.cone);
    if (s.kind == LimitKind::ellipse) {
      bone.limit = reference::ellipseLimit(s.angles.x, s.angles.y, s.angles.z, s.angles.w);
    }
    if (s.kind == LimitKind::hinge) bone.limit = reference::hingeLimit(s.low, s.high);
    if (s.twist) bone.limit = reference::withTwist(bone.limit, s.twist->first, s.twist->second);
    bones.push_back(bone);
  }
  return reference::makeIkChain(bones, pole);
}

ChainSpec bentSpec(size_t bones) {
  ChainSpec spec(bones);
  for (size_t i = 0; i < bones; ++i) {
    const double share = bones > 1 ? static_cast<double>(i) / static_cast<double>(bones - 1) : 0;
    const double angle = (60 - 140 * share) * degree;
    spec[i].direction = {std::cos(angle), std::sin(angle), 0};
  }
  return spec;
}

ChainSpec coneSpec(size_t bones, double halfAngle) {
  ChainSpec spec = bentSpec(bones);
  for (BoneSpec& bone : spec) {
    bone.kind = LimitKind::cone;
    bone.cone = halfAngle;
  }
  return spec;
}

ChainSpec ellipseSpec(size_t bones) {
  ChainSpec spec = bentSpec(bones);
  for (BoneSpec& bone : spec) {
    bone.kind = LimitKind::ellipse;
    bone.angles = glm::dvec4(30, 70, 40, 20) * degree;
  }
  return spec;
}

ChainSpec hingeSpec(size_t bones) {
  ChainSpec spec = bentSpec(bones);
  for (size_t i = 1; i < bones; ++i) {
    spec[i].kind = LimitKind::hinge;
    spec[i].low = -60 * degree;
    spec[i].high = 60 * degree;
  }
  return spec;
}

ChainSpec mixedSpec() {
  ChainSpec spec = bentSpec(5);
  spec[0].kind = LimitKind::cone;
  spec[0].cone = 80 * degree;
  spec[0].twist = {-30 * degree, 50 * degree};
  spec[1].kind = LimitKind::ellipse;
  spec[1].angles = glm::dvec4(70, 30, 40, 60) * degree;
  spec[1].length = 0.7;
  spec[2].kind = LimitKind::hinge;
  spec[2].axis = glm::normalize(glm::dvec3(0.4, 0.3, 1));
  spec[2].low = -100 * degree;
  spec[2].high = 40 * degree;
  spec[2].length = 1.4;
  spec[3].direction = {0, 0.2, -1};
  spec[4].kind = LimitKind::cone;
  spec[4].cone = 45 * degree;
  spec[4].length = 0.5;
  return spec;
}

Verdict judge(const ChainSpec& spec, const reference::Joints& joints,
              const std::vector<glm::dmat3>& rotations) {
  Verdict verdict;
  double total = 0;
  for (const BoneSpec& bone : spec) total += bone.length;
  glm::dmat3 before(1);
  for (size_t i = 0; i < spec.size(); ++i) {
    const BoneSpec& bone = spec[i];
    const glm::dvec3 along = joints[i + 1] - joints[i], rest = glm::normalize(bone.direction);
    verdict.stretch = std::max(verdict.stretch, std::abs(glm::length(along) - bone.length / total));
    const glm::dvec3 v = bone.length > 0 ? glm::transpose(before) * glm::normalize(along) : rest;
    glm::dmat3 turn = shortestArc(rest, v);
    if (bone.kind == LimitKind::hinge) {
      const double q = angleAbout(bone.axis, rest, v);
      turn = about(bone.axis, q);
      verdict.beyond =
          std::max({verdict.beyond, outside(q, bone.low, bone.high), angleBetween(turn * rest, v)});
    } else {
      verdict.beyond = std::max(verdict.beyond, beyondSwing(bone, v));
    }
    if (bone.twist) {
      const glm::dvec3 aside = glm::normalize(glm::cross(rest, glm::dvec3(0.6, 0.5, 0.4)));
      const glm::dvec3 turned = glm::transpose(before) * (rotations[i] * aside);
      const double tau = angleAbout(v, turn * aside, turned);
      verdict.beyond = std::max(verdict.beyond, outside(tau, bone.twist->first, bone.twist->second));
      turn = about(v, tau) * turn;
    }
    before = before * turn;
    for (int axis = 0; axis < 3; ++axis) {
      verdict.rotation = std::max(verdict.rotation, glm::length(rotations[i][axis] - before[axis]));
    }
  }
  return verdict;
}

std::vector<glm::dmat3> rotationsOf(const reference::IkChain& chain, const reference::IkState& state) {
  return chain.free ? reference::rotationsOf(chain, state.joints) : reference::rotationsOf(chain, state.pose);
}

reference::IkResult solve(const reference::IkChain& chain, const reference::IkSettings& settings,
                          const glm::dvec3& target) {
  reference::IkMemory memory;
  return reference::solveIk(chain, settings, target, reference::restState(chain), memory);
}

glm::dvec3 randomPoint(std::mt19937_64& random, double low, double high) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double z = 2 * unit(random) - 1, around = glm::two_pi<double>() * unit(random),
               s = std::sqrt(1 - z * z);
  const double distance = std::cbrt(glm::mix(low * low * low, high * high * high, unit(random)));
  return distance * glm::dvec3(s * std::cos(around), s * std::sin(around), z);
}

}  // namespace skitter::test

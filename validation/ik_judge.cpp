#include "validation/ik_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace skitter::validation {
namespace {

using glm::dmat3;
using glm::dquat;
using glm::dvec3;

constexpr double infiniteError = std::numeric_limits<double>::infinity();
// Shorter than this, a bone has no direction that could be measured.
constexpr double noLength = 1e-12;
// Of the difference of two joints, a share of the chain's length.
constexpr double jointRounding = 0x1p-23;
// Sine of an angle from rest beyond which there are free balls only.
constexpr double nearlyAgainst = 0.04;

bool isFinite(const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

dmat3 turn(const dvec3& unitAxis, double angle) { return glm::mat3_cast(glm::angleAxis(angle, unitAxis)); }

// Takes Z to the unit d by the shortest way; the opposite of Z by a half turn about X.
dmat3 swingTo(const dvec3& d) {
  const double sine = std::hypot(d.x, d.y);
  const dvec3 axis = sine > 0 ? dvec3(-d.y, d.x, 0) / sine : dvec3(1, 0, 0);
  return turn(axis, std::atan2(sine, d.z));
}

double angleBetween(const dvec3& a, const dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

dmat3 ballFrame(const dvec3& rest) {
  const dvec3 x = rest.z < -0.999999 ? dvec3(1, 0, 0) : swingTo(rest)[0];
  const dvec3 across = glm::normalize(x - rest * glm::dot(x, rest));
  return {across, glm::cross(rest, across), rest};
}

dmat3 hingeFrame(const dvec3& rest, const dvec3& axis) {
  const dvec3 z = glm::normalize(rest - axis * glm::dot(axis, rest));
  return {axis, glm::cross(z, axis), z};
}

dmat3 frameOf(const IkJudge::Bone& bone) {
  const dvec3 rest = glm::normalize(bone.rest);
  const auto* hinge = std::get_if<judged::Hinge>(&bone.limit);
  return hinge ? hingeFrame(rest, glm::normalize(hinge->axis)) : ballFrame(rest);
}

bool isHinge(const auto& bone) { return std::holds_alternative<judged::Hinge>(bone.limit); }

// The bone's own turn from its frame at rest to where `d` shows it, without twist.
dmat3 turnOf(const auto& bone, const dvec3& d) {
  return isHinge(bone) ? turn({1, 0, 0}, std::atan2(-d.y, d.z)) : swingTo(d);
}

// A ball's turn beyond its swing.
double twistOf(const dmat3& turned) {
  const dmat3 twist = glm::transpose(swingTo(turned[2])) * turned;
  return std::atan2(twist[0].y, twist[0].x);
}

bool hasTwist(const auto& bone) { return bone.twistMin != 0 || bone.twistMax != 0; }

}  // namespace

IkJudge::IkJudge(std::vector<Bone> bones) {
  for (const Bone& bone : bones) {
    bones_.push_back(
        {bone.length, glm::normalize(bone.rest), frameOf(bone), bone.limit, bone.twistMin, bone.twistMax});
    length_ += bone.length;
    free_ = free_ && std::holds_alternative<judged::Free>(bone.limit) && !hasTwist(bone);
  }
  if (!(length_ > 0)) throw std::invalid_argument("a chain to be judged has no length");
}

bool IkJudge::needsRotations() const {
  return std::any_of(bones_.begin(), bones_.end(), [](const RestBone& bone) { return hasTwist(bone); });
}

double IkJudge::worstLimit(std::span<const dvec3> joints) const {
  double worst = 0, unsure = 0;
  dmat3 carried(1);  // the rotation of the bone before, from rest
  for (size_t i = 0; i < bones_.size(); ++i) {
    const RestBone& bone = bones_[i];
    const dvec3 along = joints[i + 1] - joints[i];
    const double measured = glm::length(along);
    if (bone.length <= 0 || measured < noLength * length_) continue;  // it does not turn
    const dmat3 frame = carried * bone.frame;
    const dvec3 d = glm::transpose(frame) * (along / measured);
    const dvec3 rest = glm::transpose(bone.frame) * bone.direction;
    worst = std::max(worst, judged::beyond(bone.limit, d, rest) - unsure);
    carried = frame * turnOf(bone, d) * glm::transpose(bone.frame);
    // A ball's turn is as sure as the way in which it leans, and joints are float32: where a free one points
    // nearly against rest, their roundings turn everything beyond it.
    const double leaning = std::hypot(d.x, d.y);
    if (std::holds_alternative<judged::Free>(bone.limit) && d.z < 0 && leaning < nearlyAgainst)
      unsure += 2 * jointRounding * length_ / measured / leaning;
  }
  return worst;
}

double IkJudge::worstLimit(std::span<const dvec3> joints, std::span<const dquat> rotations) const {
  double worst = 0;
  dmat3 carried(1);
  for (size_t i = 0; i < bones_.size(); ++i) {
    const RestBone& bone = bones_[i];
    const dmat3 rotation = glm::mat3_cast(glm::normalize(rotations[i]));
    const dmat3 frame = carried * bone.frame;
    const dmat3 turned = glm::transpose(frame) * rotation * bone.frame;
    carried = rotation;
    const dvec3 along = joints[i + 1] - joints[i];
    if (bone.length > 0 && glm::length(along) >= noLength * length_) {
      worst = std::max(worst, angleBetween(rotation * bone.direction, along));
    }
    if (free_) continue;
    const dvec3 rest = glm::transpose(bone.frame) * bone.direction;
    worst = std::max(worst, judged::beyond(bone.limit, turned * rest, rest));
    worst = std::max(worst, isHinge(bone) ? angleBetween(turned[0], {1, 0, 0})
                                          : judged::outside(twistOf(turned), bone.twistMin, bone.twistMax));
  }
  return worst;
}

IkJudge::Verdict IkJudge::judge(const dvec3& target, std::span<const dvec3> joints,
                                std::span<const dquat> rotations) const {
  if (joints.size() != bones_.size() + 1) throw std::invalid_argument("joints do not match the judged chain");
  if (rotations.empty() && needsRotations()) {
    throw std::invalid_argument("a twist range cannot be judged without rotations");
  }
  if (!rotations.empty() && rotations.size() != bones_.size()) {
    throw std::invalid_argument("rotations do not match the judged chain");
  }
  const bool finite = std::all_of(joints.begin(), joints.end(), isFinite) &&
                      std::all_of(rotations.begin(), rotations.end(), [](const dquat& q) {
                        return std::isfinite(glm::dot(q, q)) && glm::dot(q, q) > 0;
                      });
  if (!finite) return {infiniteError, infiniteError, infiniteError};

  Verdict verdict;
  verdict.tipError = isFinite(target) ? glm::distance(target, joints.back()) / length_ : infiniteError;
  verdict.boneLengthError = glm::length(joints[0]) / length_;
  for (size_t i = 0; i < bones_.size(); ++i) {
    const double error = std::abs(glm::distance(joints[i], joints[i + 1]) - bones_[i].length) / length_;
    verdict.boneLengthError = std::max(verdict.boneLengthError, error);
  }
  verdict.limitViolation = rotations.empty() ? worstLimit(joints) : worstLimit(joints, rotations);
  return verdict;
}

}  // namespace skitter::validation

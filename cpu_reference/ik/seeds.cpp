#include "cpu_reference/ik/seeds.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>

#include "cpu_reference/rotation.h"

namespace skitter::reference {
namespace {

constexpr size_t candidates = 1024;
constexpr double pull = 0.3;

double uniform(IkRandom& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

double uniformAngle(IkRandom& random, double tanHalfLow, double tanHalfHigh) {
  return std::tan(uniform(random, std::atan(tanHalfLow), std::atan(tanHalfHigh)));
}

glm::dvec2 randomSwing(const Limit& limit, IkRandom& random) {
  if (limit.kind == LimitKind::hinge) {
    return {0, -uniformAngle(random, limit.tanHalfLow, limit.tanHalfHigh)};
  }
  for (;;) {  // ends: a limit has a share of its cap
    const double z = uniform(random, std::cos(greatestAngle(limit)), 1);
    const double around = uniform(random, 0, glm::two_pi<double>());
    const double s = std::sqrt(std::max(1 - z * z, 0.0));
    const glm::dvec2 xy = stereographic({s * std::cos(around), s * std::sin(around), z});
    if (clampSwing(limit, xy) == xy) return xy;
  }
}

// Half-angle tangent of a share of the angle.
double shareOf(double tanHalf, double share) { return std::tan(share * std::atan(tanHalf)); }

Pose pulledToRest(const std::vector<BoneRest>& bones, Pose pose) {
  for (size_t i = 0; i < bones.size(); ++i) {
    const double length = glm::length(pose.swing[i]);
    if (length > 0 && bones[i].kind != LimitKind::free) pose.swing[i] *= shareOf(length, 1 - pull) / length;
    pose.twist[i] = shareOf(pose.twist[i], 1 - pull);
  }
  return clamped(bones, pose);
}

}  // namespace

Pose randomLegalPose(const std::vector<BoneRest>& bones, IkRandom& random) {
  Pose pose = Pose::rest(bones.size());
  for (size_t i = 0; i < bones.size(); ++i) {
    if (bones[i].length == 0) continue;
    pose.swing[i] = randomSwing(bones[i], random);
    if (bones[i].twists()) {
      pose.twist[i] = uniformAngle(random, bones[i].tanHalfTwistLow, bones[i].tanHalfTwistHigh);
    }
  }
  return clamped(bones, pose);
}

bool aimsSeeds(const IkChain& chain) {
  return !chain.pole && chain.bones[0].kind == LimitKind::free && chain.bones[0].length > 0;
}

IkState aimed(const IkChain& chain, const IkState& state, const glm::dvec3& target) {
  const glm::dmat3& frame = chain.bones[0].frame;
  const glm::dvec3 to = glm::transpose(frame) * normalized(target);
  // Where the tip would be with the base at rest. A swing is a quaternion (w, x, y, 0): of what takes `from`
  // to `to` there is but one.
  const glm::dmat3 swing = shortestFromZ(direction(state.pose.swing[0]));
  const glm::dvec3 from = glm::transpose(frame * swing) * normalized(state.joints.back());
  Pose pose = state.pose;
  const double below = to.z + from.z, least = 1e-12;
  pose.swing[0] = glm::dvec2(to - from) / (std::abs(below) < least ? least : below);
  IkState turned = stateAt(chain, pose);
  turned.damping = state.damping;
  return turned;
}

std::vector<Pose> makeSeeds(const IkChain& chain, uint64_t seed, size_t count) {
  const std::vector<BoneRest>& bones = chain.bones;
  const bool shapes = aimsSeeds(chain);
  IkRandom random(seed);
  const auto tipOf = [&](const Pose& pose) {
    const glm::dvec3 tip = Posture(bones, pose).tip();
    return shapes ? glm::dvec3(glm::length(tip), 0, 0) : tip;
  };
  const glm::dvec3 rest = tipOf(clamped(bones, Pose::rest(bones.size())));
  std::vector<Pose> poses;
  std::vector<glm::dvec3> tips;
  std::vector<double> apart;  // from the nearest tip picked so far
  for (size_t i = 0; i < candidates; ++i) {
    poses.push_back(pulledToRest(bones, randomLegalPose(bones, random)));
    if (shapes) poses.back().swing[0] = {0, 0};
    tips.push_back(tipOf(poses.back()));
    apart.push_back(glm::length(tips.back() - rest));
  }
  std::vector<Pose> seeds;
  while (seeds.size() < std::min(count, candidates)) {
    const size_t pick = static_cast<size_t>(std::max_element(apart.begin(), apart.end()) - apart.begin());
    if (apart[pick] < 1e-6) break;
    seeds.push_back(poses[pick]);
    for (size_t i = 0; i < candidates; ++i) apart[i] = std::min(apart[i], glm::length(tips[i] - tips[pick]));
  }
  return seeds;
}

}  // namespace skitter::reference

#include "cpu_reference/ik/pace.h"

#include <algorithm>

namespace skitter::reference {
namespace {

constexpr double gear = 8;          // of a joint's way to its target's
constexpr double recovery = 1.5;    // of the pace, a solve whose target stands still
constexpr double unheld = 1e3;      // a pace at which nothing is held
constexpr double leastGain = 0.05;  // of a joint's way, where the target stands still
constexpr double rounding = 1e-6;   // a way that may be
constexpr int corrections = 4;

double farthest(const IkState& a, const IkState& b) {
  double most = 0;
  for (size_t i = 0; i < a.joints.size(); ++i) most = std::max(most, glm::length(a.joints[i] - b.joints[i]));
  return most;
}

glm::dvec3 between(const glm::dvec3& a, const glm::dvec3& b, double share) {
  const glm::dvec3 d = a + (b - a) * share;
  return glm::length(d) < 1e-3 ? a : glm::normalize(d);
}

IkState between(const IkChain& chain, const IkSettings& settings, const IkState& a, const IkState& b,
                double share) {
  if (movesJoints(chain, settings)) {
    const std::vector<glm::dvec3> from = directionsOf(a.joints), to = directionsOf(b.joints);
    std::vector<glm::dvec3> directions;
    for (size_t i = 0; i < from.size(); ++i) directions.push_back(between(from[i], to[i], share));
    return {b.pose, laidOut(chain.bones, directions)};
  }
  Pose pose = a.pose;
  for (size_t i = 0; i < chain.bones.size(); ++i) {
    const glm::dvec2 to = b.pose.swing[i];
    if (chain.bones[i].kind == LimitKind::hinge) {
      pose.swing[i] += (to - pose.swing[i]) * share;
    } else if (chain.bones[i].length > 0) {
      pose.swing[i] = stereographic(between(direction(pose.swing[i]), direction(to), share));
    }
    pose.twist[i] += (b.pose.twist[i] - pose.twist[i]) * share;
  }
  return stateAt(chain, pose);
}

// On the way from `a` to `b`, as far as no joint moves by more than `most`.
IkState held(const IkChain& chain, const IkSettings& settings, const IkState& a, const IkState& b,
             double most) {
  double share = most / farthest(a, b);
  for (int i = 0; i < corrections; ++i) {
    const double way = farthest(a, between(chain, settings, a, b, share));
    if (way > most) share *= most / way;
  }
  return between(chain, settings, a, b, share);
}

}  // namespace

void keepPace(const IkChain& chain, const IkSettings& settings, const glm::dvec3& target,
              const IkState& start, bool jumped, IkResult& result, IkMemory& memory) {
  if (!memory.target) {
    memory.target = target;
    return;
  }
  const double way = glm::length(target - *memory.target);
  const bool stands = way == 0;
  memory.target = target;
  memory.pace = stands ? std::min(recovery * memory.pace, unheld) : way;
  const double moved = farthest(start, result.state), most = gear * memory.pace;
  const double gain = start.error(target) - result.error;
  const bool idle =
      way < 2 * rounding && result.error > settings.tolerance && gain < leastGain * moved + rounding;
  if (!idle && jumped) result.stop = IkStop::jumped;
  if (!idle && (jumped || memory.pace >= fastTarget || moved <= most + rounding)) return;
  const double damping = result.state.damping;
  result.state = idle ? start : held(chain, settings, start, result.state, most);
  result.state.damping = damping;
  result.error = result.state.error(target);
  if (!idle) result.stop = result.error > settings.tolerance ? IkStop::held : IkStop::tolerance;
}

}  // namespace skitter::reference

#pragma once

#include "cpu_reference/stages/swing_key_poses.h"
#include "cpu_reference/stages/tolerances.h"

// As tolerances.h, of controller key-poses.
namespace skitter::reference::tolerance {

// v_e (2 roundoff), two products or quotients (4 more), a sum below 2 + what is added, its floor.
inline double wheel(const Tuning& t, double stride, const AgentBody& body) {
  const double advance = body.pace(t) * t.dt / stride;
  return roundoff * (8 * advance + 3 * (1 + advance));
}

struct PoseBounds {
  std::vector<double> directions, rates;  // of each bone
  double tip = 0;                         // metres
  double stance = 0, walking = 0;         // of SprungLeg's margins
};
// `t` is that of an agent that ticks in every `span`-th tick of the crowd, 1, 2, 4 or 8.
inline PoseBounds poseSwing(const Tuning& t, const KeyPoses& poses, const Limb& limb, size_t leg,
                            const AgentBody& body, const KeyPoses::Directions& directions,
                            const KeyPoses::Directions& rates, const SprungLeg& expected, double span) {
  PoseBounds bound;
  const KeyPoses::Leg& pose = poses.legs[leg];
  const auto keys = static_cast<double>(pose.keys.size());
  const double lead = (2 * t.springDamping / t.springFrequency + t.dt / 2) * body.pace(t) / poses.stride;
  // A sum below 1 + lead, of which the lead is known to 12 roundoff; K times it rounds once more.
  const double place = keys * roundoff * (12 * lead + 2 * (1 + lead) + 1);
  const glm::dmat2 step = springStep(t.springFrequency, t.springDamping, t.dt);
  double turned = 0, steepest = 0;
  for (size_t bone = 0; bone < limb.bones.size(); ++bone) {
    double apart = 0, size = glm::length(pose.standing[bone]), tangent = 0;
    for (size_t k = 0; k < pose.keys.size(); ++k) {
      const glm::dvec2 &p = pose.keys[k][bone], &next = pose.keys[(k + 1) % pose.keys.size()][bone];
      apart = std::max(apart, glm::length(next - p));
      size = std::max(size, glm::length(p));
      tangent = std::max(tangent, glm::length(pose.tangents[k][bone]));
    }
    // Between keys at most D apart with tangents of at most M the control points of the segment's derivative
    // are at most M, 3 D + 2 M and M, and the middle one weighs at most 1/2. Weights err by 8 roundoff; those
    // of tangents are at most 4/27. Then the four's sum and the mix with w, 8 roundoff each.
    const double goal = (1.5 * apart + 2 * tangent) * place + 32 * roundoff * (size + tangent);
    const double in = glm::length(directions[bone]) + glm::length(expected.goals[bone]);
    const double rate = glm::length(rates[bone]);
    // E's numbers are good to 2 roundoff each; the difference, two products and sums. A device squares the E
    // of one tick: with rates in units of the frequency a spring's energy is a norm, which E does not raise,
    // so that a square doubles what E errs by and adds 4 roundoff.
    const double squared = (8 * span - 8) * roundoff * (in + rate / t.springFrequency);
    bound.directions.push_back(std::abs(1 - step[0][0]) * goal +
                               8 * roundoff * (in + std::abs(step[1][0]) * rate) + squared);
    bound.rates.push_back(std::abs(step[0][1]) * goal +
                          8 * roundoff * (std::abs(step[0][1]) * in + std::abs(step[1][1]) * rate) +
                          t.springFrequency * squared);
    // The sphere's stereographic image is half as large at its middle and larger elsewhere.
    turned += 2 * bound.directions.back();
    steepest = std::max(steepest, glm::length(expected.chain.directions[bone]));
  }
  const int bones = static_cast<int>(limb.bones.size());
  bound.tip = limb.reach * (turned + forwardKinematics(bones, steepest)) +
              rotated(limb.reach + glm::length(limb.root));
  bound.stance = 4 * roundoff;
  bound.walking = 8 * roundoff;
  return bound;
}

}  // namespace skitter::reference::tolerance

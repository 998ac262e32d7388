#include "cpu_reference/stages/swing_key_poses.h"

#include "cpu_reference/ik/kinematics.h"

namespace skitter::reference {
namespace {

double fraction(double x) { return x - std::floor(x); }

}  // namespace

// Scaling and squaring (Moler & Van Loan 2003) of the Taylor series.
glm::dmat2 springStep(double frequency, double damping, double dt) {
  glm::dmat2 a{glm::dvec2(0, -frequency * frequency), glm::dvec2(1, -2 * damping * frequency)};  // columns
  a *= dt;
  const double norm = std::max(std::abs(a[0][1]) + std::abs(a[0][0]), std::abs(a[1][0]) + std::abs(a[1][1]));
  const int halvings = norm > 0.25 ? 2 + static_cast<int>(std::ceil(std::log2(norm))) : 0;
  a *= std::ldexp(1.0, -halvings);
  glm::dmat2 sum(1), term(1);
  for (int n = 1; n <= 14; ++n) {
    term = term * a / static_cast<double>(n);
    sum += term;
  }
  for (int n = 0; n < halvings; ++n) sum = sum * sum;
  return sum;
}

// As a Bezier segment, by de Casteljau's construction.
glm::dvec2 closedCurve(const KeyPoses::Leg& pose, size_t bone, size_t k, double s) {
  const size_t next = k + 1 == pose.keys.size() ? 0 : k + 1;
  std::vector<glm::dvec2> points = {pose.keys[k][bone], pose.keys[k][bone] + pose.tangents[k][bone] / 3.0,
                                    pose.keys[next][bone] - pose.tangents[next][bone] / 3.0,
                                    pose.keys[next][bone]};
  for (size_t left = 3; left > 0; --left)
    for (size_t i = 0; i < left; ++i) points[i] = (1 - s) * points[i] + s * points[i + 1];
  return points[0];
}

SprungLeg poseSwing(const Tuning& tuning, const KeyPoses& poses, const Limb& limb, size_t leg,
                    const AgentBody& body, double phase, const KeyPoses::Directions& directions,
                    const KeyPoses::Directions& rates) {
  const KeyPoses::Leg& pose = poses.legs[leg];
  const double pace = body.pace(tuning), walking = std::min(1.0, pace / tuning.poseWalk);
  const double lead = 2 * tuning.springDamping / tuning.springFrequency - tuning.dt / 2;
  const size_t keys = pose.keys.size();
  const double place = fraction(phase + lead * pace / poses.stride) * static_cast<double>(keys);
  const size_t k = std::min(static_cast<size_t>(place), keys - 1);
  const glm::dmat2 step = springStep(tuning.springFrequency, tuning.springDamping, tuning.dt);

  SprungLeg result;
  for (size_t bone = 0; bone < limb.bones.size(); ++bone) {
    const glm::dvec2 curve = closedCurve(pose, bone, k, place - static_cast<double>(k));
    const glm::dvec2 goal = (1 - walking) * pose.standing[bone] + walking * curve;
    glm::dvec2 direction, rate;
    for (int c = 0; c < 2; ++c) {
      const glm::dvec2 after = step * glm::dvec2(directions[bone][c] - goal[c], rates[bone][c]);
      direction[c] = goal[c] + after.x;
      rate[c] = after.y;
    }
    result.goals.push_back(goal);
    result.chain.directions.push_back(direction);
    result.rates.push_back(rate);
  }
  const Posture posture(limb, result.chain.directions);
  result.chain.tip = body.orientation * (limb.root + limb.reach * posture.tip());

  const double since = fraction(phase - pose.land);
  result.stanceMargin = std::min({since, 1 - since, std::abs(since - pose.stand)});
  result.walkMargin = std::abs(walking - 0.5);
  result.foot = {result.chain.tip, walking < 0.5 || since < pose.stand ? 1 : 0.5};
  return result;
}

}  // namespace skitter::reference

// Controller key-poses: key poses, the curve through them, and springs that follow it.
#include <gtest/gtest.h>

#include "cpu_reference/ik/kinematics.h"
#include "cpu_reference/stages/gait_key_poses.h"
#include "cpu_reference/stages/swing_key_poses.h"
#include "spider.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

using reference::KeyPoses;

constexpr double kTwoPi = 6.283185307179586;

class KeyPose : public testing::Test {
 protected:
  KeyPose() {
    tuning.poseWalk = 0.1;
    tuning.springFrequency = 45;
    tuning.springDamping = std::sqrt(0.5);
    poses.stride = 0.6;
    // Every bone draws an ellipse, once a cycle.
    KeyPoses::Leg leg;
    leg.standing = KeyPoses::Directions(4, glm::dvec2(0.02, 0.03));
    for (int k = 0; k < 4; ++k) {
      leg.keys.emplace_back(4, ellipse(k / 4.0));
      leg.tangents.emplace_back(4, slope(k / 4.0) / 4.0);
    }
    leg.land = 0.9;
    leg.stand = 0.6;
    poses.legs.assign(8, leg);
    body.surfaceSpeed = body.speed = 1;
  }
  static glm::dvec2 ellipse(double phase) {
    return {0.1 + 0.2 * std::cos(kTwoPi * phase), 0.3 * std::sin(kTwoPi * phase)};
  }
  static glm::dvec2 slope(double phase) {
    return kTwoPi * glm::dvec2(-0.2 * std::sin(kTwoPi * phase), 0.3 * std::cos(kTwoPi * phase));
  }
  reference::SprungLeg tick(double phase, const KeyPoses::Directions& from,
                            const KeyPoses::Directions& rates) const {
    return reference::poseSwing(tuning, poses, creature.limbs[2], 2, body, phase, from, rates);
  }

  Heightfield terrain = flatField();
  reference::Tuning tuning = validation::tuningOf(parametersFor(terrain));
  reference::Creature creature = spiderCreature();
  reference::AgentBody body = bodyAt(0.5, 0.5);
  KeyPoses poses;
  const KeyPoses::Directions none = KeyPoses::Directions(4, glm::dvec2(0));
};

TEST_F(KeyPose, aKeyIsHitAtItsPhaseWithItsTangent) {
  const KeyPoses::Leg& leg = poses.legs[0];
  const double tiny = 1e-6;
  for (size_t k = 0; k < 4; ++k) {
    const size_t next = (k + 1) % 4;
    EXPECT_EQ(reference::closedCurve(leg, 0, k, 0), leg.keys[k][0]);
    EXPECT_EQ(reference::closedCurve(leg, 0, k, 1), leg.keys[next][0]);
    const glm::dvec2 after = (reference::closedCurve(leg, 0, k, tiny) - leg.keys[k][0]) / tiny;
    const glm::dvec2 before = (leg.keys[next][0] - reference::closedCurve(leg, 0, k, 1 - tiny)) / tiny;
    EXPECT_LT(glm::length(after - leg.tangents[k][0]), 1e-5);
    EXPECT_LT(glm::length(before - leg.tangents[next][0]), 1e-5);
  }
}

TEST_F(KeyPose, whatIsCubicIsFollowedExactly) {
  const auto cubic = [](double s) { return glm::dvec2(1 - 2 * s + 3 * s * s * s, s * s - s * s * s); };
  KeyPoses::Leg leg;
  leg.keys = {{cubic(0)}, {cubic(1)}};
  leg.tangents = {{glm::dvec2(-2, 0)}, {glm::dvec2(7, -1)}};
  for (const double s : {0.1, 0.4, 0.75})
    EXPECT_LT(glm::length(reference::closedCurve(leg, 0, 0, s) - cubic(s)), 1e-14);
}

TEST_F(KeyPose, springsAreSolvedInClosedForm) {
  const double w = 45;
  for (const double dt : {1e-3, 1.0 / 60, 0.1, 1.0}) {
    const glm::dmat2 free = reference::springStep(w, 0, dt);
    EXPECT_NEAR(free[0][0], std::cos(w * dt), 1e-11);
    EXPECT_NEAR(free[1][0], std::sin(w * dt) / w, 1e-11);
    EXPECT_NEAR(free[0][1], -w * std::sin(w * dt), 1e-9);
    const glm::dmat2 critical = reference::springStep(w, 1, dt);
    EXPECT_NEAR(critical[0][0], (1 + w * dt) * std::exp(-w * dt), 1e-11);
    EXPECT_NEAR(critical[1][0], dt * std::exp(-w * dt), 1e-11);
    EXPECT_NEAR(critical[1][1], (1 - w * dt) * std::exp(-w * dt), 1e-11);
  }
}

TEST_F(KeyPose, aCriticalSpringNeverOvershootsAndAnySettles) {
  body.surfaceSpeed = body.speed = 0;  // the goal is the standing pose
  for (const double damping : {0.3, std::sqrt(0.5), 1.0}) {
    for (const double dt : {1.0 / 60, 0.5}) {
      tuning.springDamping = damping;
      tuning.dt = dt;
      KeyPoses::Directions at(4, glm::dvec2(-0.5)), rates = none;
      double last = 1;
      for (int n = 0; n < 120; ++n) {
        const reference::SprungLeg next = tick(0.3, at, rates);
        at = next.chain.directions;
        rates = next.rates;
        const double off = next.goals[0].x - at[0].x;
        EXPECT_LE(std::abs(off), 0.52);
        if (damping == 1) {
          EXPECT_GE(off, 0);
          EXPECT_LE(off, last);
        }
        last = off;
      }
      EXPECT_LT(glm::length(at[3] - glm::dvec2(0.02, 0.03)), 1e-9);
      EXPECT_LT(glm::length(rates[3]), 1e-7);
    }
  }
}

// At a steady pace the spring's lag and the lead of its goal cancel, and its damping keeps the size.
TEST_F(KeyPose, legsAreInTimeWithThePhase) {
  double phase = 0, worst = 0;
  KeyPoses::Directions at = none, rates = none;
  for (int n = 0; n < 240; ++n) {
    phase = reference::wheelPhase(tuning, poses.stride, body, phase);
    const reference::SprungLeg leg = tick(phase, at, rates);
    at = leg.chain.directions;
    rates = leg.rates;
    if (n >= 60) worst = std::max(worst, glm::length(at[1] - ellipse(phase)));
  }
  EXPECT_LT(worst, 0.006);  // of 0.3; the curve through four keys alone is off by 0.005
}

TEST_F(KeyPose, fadesToTheStandingPose) {
  const KeyPoses::Directions walking = tick(0.4, none, none).goals;
  body.surfaceSpeed = body.speed = 0.05;
  poses.stride = 1e12;  // no lead
  const KeyPoses::Directions half = tick(0.4, none, none).goals;
  body.surfaceSpeed = body.speed = 0;
  const reference::SprungLeg still = tick(0.4, none, none);
  EXPECT_LT(glm::length(still.goals[0] - glm::dvec2(0.02, 0.03)), 1e-15);
  body.surfaceSpeed = body.speed = 1;
  const KeyPoses::Directions whole = tick(0.4, none, none).goals;
  EXPECT_LT(glm::length(half[0] - (still.goals[0] + whole[0]) / 2.0), 1e-12);
  EXPECT_GT(glm::length(walking[0] - whole[0]), 1e-3);  // by the lead
}

TEST_F(KeyPose, feetStandForTheirShareAndWhileThereIsNoWalking) {
  const auto stands = [&](double phase) { return tick(phase, none, none).foot.progress == 1; };
  EXPECT_FALSE(stands(0.89));
  EXPECT_TRUE(stands(0.91));
  EXPECT_TRUE(stands(0.49));
  EXPECT_FALSE(stands(0.51));
  EXPECT_NEAR(tick(0.49, none, none).stanceMargin, 0.01, 1e-12);
  EXPECT_NEAR(tick(0.92, none, none).stanceMargin, 0.02, 1e-12);
  body.surfaceSpeed = body.speed = 0.049;
  EXPECT_TRUE(stands(0.51));
}

TEST_F(KeyPose, theTipIsWhereTheBonesEnd) {
  body.orientation = glm::normalize(glm::dquat(0.9, 0.2, -0.1, 0.3));
  const reference::SprungLeg leg = tick(0.2, none, none);
  const reference::Limb& limb = creature.limbs[2];
  const reference::Posture posture(limb, leg.chain.directions);
  EXPECT_LT(glm::length(leg.chain.tip - body.orientation * (limb.root + limb.reach * posture.tip())), 1e-12);
  EXPECT_EQ(leg.foot.target, leg.chain.tip);
}

TEST_F(KeyPose, theWheelTurnsOnceAStrideHoweverFast) {
  double phase = 0, way = 0;
  for (int n = 0; n < 100; ++n) {
    body.surfaceSpeed = body.speed = 0.02 * n;
    way += body.surfaceSpeed * tuning.dt;
    phase = reference::wheelPhase(tuning, poses.stride, body, phase);
    EXPECT_GE(phase, 0);
    EXPECT_LT(phase, 1);
  }
  EXPECT_NEAR(phase, way / poses.stride - std::floor(way / poses.stride), 1e-12);
  body.surfaceSpeed = body.speed = 0;
  EXPECT_EQ(reference::wheelPhase(tuning, poses.stride, body, phase), phase);
}

}  // namespace
}  // namespace skitter::test

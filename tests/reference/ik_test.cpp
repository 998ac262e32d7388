#include "cpu_reference/stages/ik.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "cpu_reference/ik/kinematics.h"
#include "spider.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

using reference::Chain;
using reference::Limb;
using reference::Posture;

class Ik : public testing::Test {
 protected:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  // Uniform on the cap of each bone's cone.
  std::vector<glm::dvec2> legalPose(const Limb& limb) {
    std::vector<glm::dvec2> pose;
    for (const auto& bone : limb.bones) {
      const double z = uniform(std::cos(2 * std::atan(bone.tanHalfCone)), 1), around = uniform(0, 6.2831853);
      const double s = std::sqrt(1 - z * z);
      pose.push_back(reference::stereographic({s * std::cos(around), s * std::sin(around), z}));
    }
    return pose;
  }

  // A chain of equal bones, bent a little at rest, with cones of the same half-angle.
  static Limb chainOfCones(int bones, double halfAngle, double bend) {
    Limb limb;
    limb.reach = 1;
    for (int i = 0; i < bones; ++i) {
      const double angle = bend * i;
      reference::BoneRest bone;
      bone.frame = glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, std::cos(angle), std::sin(angle)),
                              glm::dvec3(0, -std::sin(angle), std::cos(angle)));
      bone.length = 1.0 / bones;
      bone.tanHalfCone = std::tan(halfAngle / 2);
      bone.stiffness = 1;
      limb.bones.push_back(bone);
    }
    return limb;
  }

  static Chain rest(const Limb& limb) {
    Chain chain;
    chain.directions.resize(limb.bones.size());
    return chain;
  }

  Chain solve(const Limb& limb, const glm::dvec3& target, const Chain& start, int fabrik, int polish) const {
    return reference::ik(tuning, limb, bodyAt(0, 0), {limb.root + limb.reach * target, 1}, start,
                         {reference::IkSolver::fabrik, fabrik, polish});
  }

  static double violation(const Limb& limb, const Chain& chain) {
    double worst = 0;
    for (size_t i = 0; i < limb.bones.size(); ++i) {
      worst = std::max(
          worst, 2 * (std::atan(glm::length(chain.directions[i])) - std::atan(limb.bones[i].tanHalfCone)));
    }
    return worst;
  }

  struct Tracking {
    double solved = 0, p99 = 0, worstViolation = 0;
  };
  // Targets from legal poses that move from one random pose to the next, the tip at `pace` of the reach a
  // tick.
  Tracking track(const std::vector<Limb>& limbs, int fabrik, int polish, double pace, int paths) {
    std::vector<double> errors;
    Tracking tracking;
    for (int path = 0; path < paths; ++path) {
      const Limb& limb = limbs[static_cast<size_t>(path) % limbs.size()];
      std::vector<glm::dvec2> from = legalPose(limb);
      Chain chain = rest(limb);
      chain = solve(limb, Posture(limb, from).tip(), chain, 2, 20);
      glm::dvec3 tip = Posture(limb, from).tip();
      for (int leg = 0; leg < 4; ++leg) {
        const std::vector<glm::dvec2> to = legalPose(limb);
        std::vector<glm::dvec2> between = from;
        for (double t = 0; t < 1; t += 2e-3) {
          for (size_t i = 0; i < from.size(); ++i) between[i] = glm::mix(from[i], to[i], t);
          const glm::dvec3 next = Posture(limb, between).tip();
          if (glm::length(next - tip) < pace) continue;
          tip = next;
          chain = solve(limb, tip, chain, fabrik, polish);
          errors.push_back(chain.reachError / limb.reach);
          tracking.worstViolation = std::max(tracking.worstViolation, violation(limb, chain));
        }
        from = to;
      }
    }
    std::sort(errors.begin(), errors.end());
    const auto within = std::lower_bound(errors.begin(), errors.end(), 1e-3) - errors.begin();
    tracking.solved = static_cast<double>(within) / static_cast<double>(errors.size());
    tracking.p99 = errors[errors.size() * 99 / 100];
    return tracking;
  }

  reference::Tuning tuning = validation::tuningOf(parametersFor(flatField()));
  std::mt19937_64 random_{20240607};
};

// solver.md's cold start: FABRIK twice, then active-set steps, 10 in all, solves 99.98 % of such targets.
TEST_F(Ik, coldStartReachesLegalTargets) {
  for (const double degrees : {30.0, 60.0}) {
    const Limb limb = chainOfCones(4, degrees * 0.017453292519943295, 0.17453292519943295);
    int solved = 0;
    constexpr int trials = 1000;
    for (int trial = 0; trial < trials; ++trial) {
      const glm::dvec3 target = Posture(limb, legalPose(limb)).tip();
      // As a crowd brings its chains to their feet before the first tick: by ticks that change nothing else.
      Chain chain = rest(limb);
      for (int tick = 0; tick < 8; ++tick) chain = solve(limb, target, chain, 2, 2);
      if (chain.reachError < 1e-3) ++solved;
      ASSERT_LE(violation(limb, chain), 1e-12);
    }
    RecordProperty("solved" + std::to_string(static_cast<int>(degrees)), solved);
    EXPECT_GE(solved, trials * 99 / 100) << degrees << " degrees";
  }
}

TEST_F(Ik, trackingStaysOnTarget) {
  const Tracking cones = track({chainOfCones(4, 1.0471975512, 0.17453292519943295)}, 0, 2, 0.02, 40);
  EXPECT_GE(cones.solved, 0.995);
  EXPECT_LE(cones.worstViolation, 1e-12);
}

TEST_F(Ik, spiderLegsTrack) {
  const auto limbs = spiderCreature().limbs;
  for (const auto& [fabrik, polish] : {std::pair{1, 2}, {0, 2}, {2, 2}, {0, 3}, {1, 3}}) {
    random_.seed(99);
    const Tracking tracking = track(limbs, fabrik, polish, 0.02, 80);
    const std::string name = "fabrik" + std::to_string(fabrik) + "polish" + std::to_string(polish);
    RecordProperty(name, std::to_string(tracking.solved) + " p99 " + std::to_string(tracking.p99));
    EXPECT_GE(tracking.solved, 0.98) << name;
    EXPECT_LE(tracking.worstViolation, 1e-12) << name;
  }
}

TEST_F(Ik, straightChainBendsTowardATargetOnItsLine) {
  const Limb limb = chainOfCones(4, 1.2, 0);
  Chain chain = rest(limb);
  EXPECT_NEAR(glm::length(Posture(limb, chain.directions).tip() - glm::dvec3(0, 0, 1)), 0, 1e-12);
  // The zigzag that breaks the deadlock comes no nearer than its cones let it fold.
  for (int tick = 0; tick < 10; ++tick) chain = solve(limb, {0, 0, 0.9}, chain, 1, 2);
  EXPECT_LT(chain.reachError, 1e-3);
  EXPECT_LE(violation(limb, chain), 1e-12);
}

TEST_F(Ik, targetBeyondReachIsFacedAtFullStretch) {
  const Limb limb = chainOfCones(4, 1.2, 0.1);
  Chain chain = rest(limb);
  for (int tick = 0; tick < 60; ++tick) chain = solve(limb, {0.9, 0, 1.2}, chain, 1, 2);
  EXPECT_NEAR(chain.reachError, 0.5, 5e-3);
  EXPECT_LE(violation(limb, chain), 1e-12);
}

TEST_F(Ik, targetAtTheRootKeepsAFiniteLegalPose) {
  const Limb limb = chainOfCones(4, 1.0, 0.1);
  Chain chain = rest(limb);
  for (int tick = 0; tick < 60; ++tick) {
    chain = solve(limb, {0, 0, 0}, chain, 1, 2);
    for (const auto& xy : chain.directions) ASSERT_TRUE(std::isfinite(xy.x + xy.y));
    ASSERT_LE(violation(limb, chain), 1e-12);
  }
  // Cones of 57 degrees cannot fold four bones wholly back, but they can come well inside the reach.
  EXPECT_LT(chain.reachError, 0.5);
}

TEST_F(Ik, zeroLengthBonesDoNotMatter) {
  const Limb plain = spiderCreature().limbs[0];
  Limb padded = plain;
  reference::BoneRest none;
  none.frame = plain.bones.back().frame;
  none.tanHalfCone = 1;
  padded.bones.push_back(none);
  padded.bones.push_back(none);
  for (int trial = 0; trial < 100; ++trial) {
    const glm::dvec3 target = Posture(plain, legalPose(plain)).tip();
    const Chain a = solve(plain, target, rest(plain), 1, 2), b = solve(padded, target, rest(padded), 1, 2);
    for (size_t i = 0; i < plain.bones.size(); ++i) {
      EXPECT_NEAR(glm::length(a.directions[i] - b.directions[i]), 0, 1e-9);
    }
    EXPECT_NEAR(a.reachError, b.reachError, 1e-9);
    EXPECT_TRUE(std::isfinite(b.directions[4].x + b.directions[5].y));
  }
}

TEST_F(Ik, targetThatIsNotFiniteKeepsThePose) {
  const Limb limb = spiderCreature().limbs[0];
  Chain chain = rest(limb);
  chain.directions = legalPose(limb);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const Chain kept = solve(limb, {0, bad, 0}, chain, 1, 2);
    EXPECT_EQ(kept.directions, chain.directions);
    EXPECT_EQ(kept.reachError, 0);
    EXPECT_TRUE(std::isfinite(kept.tip.x + kept.tip.y + kept.tip.z));
  }
}

TEST_F(Ik, onTargetTheRestPullBringsTheChainBackSlowly) {
  const Limb limb = chainOfCones(4, 1.2, 0.2);
  Chain chain = rest(limb);
  chain.directions = legalPose(limb);
  const glm::dvec3 target = Posture(limb, chain.directions).tip();
  const auto bent = [](const Chain& c) {
    double sum = 0;
    for (const auto& xy : c.directions) sum += glm::dot(xy, xy);
    return sum;
  };
  const double before = bent(chain);
  for (int tick = 0; tick < 200; ++tick) chain = solve(limb, target, chain, 1, 2);
  EXPECT_LT(chain.reachError, 1e-3);
  EXPECT_LT(bent(chain), before);
}

TEST_F(Ik, unreachableTargetDoesNotShake) {
  const Limb limb = spiderCreature().limbs[1];
  Chain chain = rest(limb);
  for (int tick = 0; tick < 200; ++tick) chain = solve(limb, {-1, 1, 0}, chain, 1, 2);
  const Chain next = solve(limb, {-1, 1, 0}, chain, 1, 2);
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(glm::length(next.directions[i] - chain.directions[i]), 0, 1e-3);
}

}  // namespace
}  // namespace skitter::test

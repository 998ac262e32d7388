#include <gtest/gtest.h>

#include <algorithm>
#define GLM_ENABLE_EXPERIMENTAL
#include <glm/gtx/quaternion.hpp>

#include "cpu_reference/ik/columns.h"
#include "cpu_reference/ik/seeds.h"
#include "cpu_reference/ik/stretch_align.h"
#include "cpu_reference/ik/two_bone.h"
#include "ik_chains.h"

// What one iteration and a whole solve of each solver must do.
namespace skitter::test {
namespace {

using reference::IkChain;
using reference::IkResult;
using reference::IkSettings;
using reference::IkSolver;
using reference::IkState;
using reference::IkStop;

double length(const glm::dvec3& v) { return glm::length(v); }

// Free chains: how many of random targets at 0.2 to 0.95 of the length are reached, and in how many
// iterations.
struct Free {
  const char* name;
  IkSolver solver;
  int iterations;  // at most
  double solved;   // least share
  double mean;     // of iterations, at most
};

void PrintTo(const Free& f, std::ostream* out) { *out << f.name; }

class FreeChains : public testing::TestWithParam<Free> {};

TEST_P(FreeChains, reachRandomTargets) {
  std::mt19937_64 random(11);
  int solved = 0, trials = 0;
  double iterations = 0;
  for (const size_t bones : {3u, 4u, 9u, 15u}) {
    const ChainSpec spec = bentSpec(bones);
    const IkChain chain = chainOf(spec);
    for (int trial = 0; trial < 100; ++trial, ++trials) {
      const glm::dvec3 target = randomPoint(random, 0.2, 0.95);
      const IkResult result =
          solve(chain, {.solver = GetParam().solver, .iterations = GetParam().iterations}, target);
      iterations += result.iterations;
      if (result.error <= 1e-3) ++solved;
      EXPECT_EQ(result.stop == IkStop::tolerance, result.error <= 9e-4);
      ASSERT_NEAR(length(result.state.joints.back() - target), result.error, 1e-12);
      ASSERT_LE(judge(spec, result.state.joints, rotationsOf(chain, result.state)).stretch, 1e-12);
    }
  }
  RecordProperty("solved", solved);
  EXPECT_GE(solved, GetParam().solved * trials) << solved << " of " << trials;
  EXPECT_LE(iterations / trials, GetParam().mean);
}

// CCD and the transpose are slow near full stretch. The pseudoinverse's pull to rest keeps long chains from
// arriving.
INSTANTIATE_TEST_SUITE_P(solvers, FreeChains,
                         testing::Values(Free{"fabrik", IkSolver::fabrik, 100, 1, 6.5},
                                         Free{"ccd", IkSolver::ccd, 1000, 0.99, 70},
                                         Free{"transpose", IkSolver::transpose, 1000, 0.97, 110},
                                         Free{"pseudoinverse", IkSolver::pseudoinverse, 100, 0.75, 20},
                                         Free{"dls", IkSolver::dls, 100, 1, 7},
                                         Free{"targetAttached", IkSolver::targetAttached, 100, 1, 7},
                                         Free{"stretchAlign", IkSolver::stretchAlign, 10, 1, 1.1}),
                         [](const auto& tested) { return std::string(tested.param.name); });

// Limited chains: targets from random legal poses. FABRIK cannot turn the plane of parallel hinges: its share
// is 1 %.
struct Limited {
  const char* name;
  ChainSpec spec;
  IkSolver solver;
  double solved;  // least share
};

void PrintTo(const Limited& l, std::ostream* out) { *out << l.name; }

class LimitedChains : public testing::TestWithParam<Limited> {};

TEST_P(LimitedChains, reachTipsOfLegalPoses) {
  IkChain chain = chainOf(GetParam().spec);
  chain.seeds = reference::makeSeeds(chain, 7);
  reference::IkRandom random(12);
  constexpr int trials = 400;
  int solved = 0, iterations = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const glm::dvec3 target =
        reference::stateAt(chain, reference::randomLegalPose(chain.bones, random)).joints.back();
    const IkResult result = solve(chain, {.solver = GetParam().solver}, target);
    iterations += result.iterations;
    if (result.error <= 1e-3) ++solved;
    const Verdict verdict = judge(GetParam().spec, result.state.joints, rotationsOf(chain, result.state));
    ASSERT_LE(verdict.beyond, 1e-9);
    ASSERT_LE(verdict.stretch, 1e-12);
    ASSERT_LE(verdict.rotation, 1e-9);
    ASSERT_LE(result.iterations, 64);
    ASSERT_NEAR(length(result.state.joints.back() - target), result.error, 1e-12);
  }
  RecordProperty("solved", solved);
  EXPECT_GE(solved, GetParam().solved * trials)
      << solved << " of " << trials << ", iterations " << iterations;
}

INSTANTIATE_TEST_SUITE_P(
    kinds, LimitedChains,
    testing::Values(Limited{"cones90", coneSpec(4, 90 * degree), IkSolver::activeSet, 0.9975},
                    Limited{"cones60", coneSpec(9, 60 * degree), IkSolver::activeSet, 0.9975},
                    Limited{"cones30", coneSpec(4, 30 * degree), IkSolver::activeSet, 0.9975},
                    Limited{"ellipses", ellipseSpec(4), IkSolver::activeSet, 0.9975},
                    Limited{"ellipsesLong", ellipseSpec(9), IkSolver::activeSet, 0.9975},
                    Limited{"hinges", hingeSpec(4), IkSolver::activeSet, 0.99},
                    Limited{"hingesLong", hingeSpec(9), IkSolver::activeSet, 0.9975},
                    Limited{"mixed", mixedSpec(), IkSolver::activeSet, 0.99},
                    Limited{"cones90Fabrik", coneSpec(4, 90 * degree), IkSolver::fabrik, 0.8},
                    Limited{"hingesFabrik", hingeSpec(4), IkSolver::fabrik, 0},
                    Limited{"mixedFabrik", mixedSpec(), IkSolver::fabrik, 0},
                    Limited{"cones60Ccd", coneSpec(4, 60 * degree), IkSolver::ccd, 0.95},
                    Limited{"hingesCcd", hingeSpec(4), IkSolver::ccd, 0.55},
                    Limited{"mixedCcd", mixedSpec(), IkSolver::ccd, 0.97},
                    Limited{"cones60Transpose", coneSpec(4, 60 * degree), IkSolver::transpose, 0.9},
                    Limited{"mixedPseudoinverse", mixedSpec(), IkSolver::pseudoinverse, 0.8},
                    Limited{"ellipsesDls", ellipseSpec(4), IkSolver::dls, 0.95},
                    Limited{"hingesDls", hingeSpec(4), IkSolver::dls, 0.9},
                    Limited{"mixedDls", mixedSpec(), IkSolver::dls, 0.97}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(TwoBone, isExactAndKeepsItsSide) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> uniform(0.2, 1);
  for (int trial = 0; trial < 300; ++trial) {
    ChainSpec spec = bentSpec(2);
    spec[0].length = uniform(random);
    const glm::dvec3 pole = randomPoint(random, 1, 1);
    for (const bool withPole : {false, true}) {
      const IkChain chain = chainOf(spec, withPole ? std::optional(pole) : std::nullopt);
      const double least = std::abs(chain.bones[0].length - chain.bones[1].length);
      const glm::dvec3 target = randomPoint(random, least + 1e-3, 0.999);
      const IkResult result = solve(chain, {.solver = IkSolver::twoBone}, target);
      ASSERT_LE(result.error, 1e-9);
      ASSERT_LE(result.iterations, 1);
      ASSERT_LE(judge(spec, result.state.joints, rotationsOf(chain, result.state)).stretch, 1e-12);
      const glm::dvec3 line = glm::normalize(target), middle = result.state.joints[1];
      const glm::dvec3 wish = withPole ? pole : reference::restState(chain).joints[1];
      const glm::dvec3 side = wish - line * glm::dot(wish, line),
                       bend = middle - line * glm::dot(middle, line);
      ASSERT_NEAR(glm::dot(glm::normalize(side), glm::normalize(bend)), 1, 1e-6);
    }
  }
}

TEST(TwoBone, comesAsNearAsItCanFold) {
  ChainSpec spec = bentSpec(2);
  spec[0].length = 3;
  const IkResult result = solve(chainOf(spec), {.solver = IkSolver::twoBone}, {0, 0, 0.1});
  EXPECT_EQ(result.stop, IkStop::unreachable);
  EXPECT_EQ(result.iterations, 1);
  EXPECT_NEAR(length(result.state.joints.back() - glm::dvec3(0, 0, 0.5)), 0, 1e-12);
}

TEST(StretchAlign, arrivesInOneIteration) {
  std::mt19937_64 random(14);
  for (const size_t bones : {2u, 5u, 15u}) {
    const IkChain chain = chainOf(bentSpec(bones));
    for (int trial = 0; trial < 200; ++trial) {
      reference::Joints joints = reference::restState(chain).joints;
      const glm::dvec3 target = randomPoint(random, 0.1, 0.98);
      reference::stretchAlign(chain, target, 9e-4, false, joints);
      ASSERT_LE(length(joints.back() - target), 9e-4) << bones << " bones, target at " << length(target);
    }
  }
}

// Folded onto its base, a single bone is as long as ever.
TEST(StretchAlign, keepsABoneThatNothingStretches) {
  const IkChain chain = chainOf(bentSpec(1));
  reference::Joints joints = reference::restState(chain).joints;
  reference::stretchAlign(chain, {0, 0, 0}, 9e-4, false, joints);
  EXPECT_NEAR(length(joints[1]), 1, 1e-12);
}

// (t - p) x e = (tip - p) x e: carrying the target in place of the tip leaves the gradient as it is.
TEST(TargetAttached, turnsJointsTheSameWayAsTheTip) {
  const IkChain chain = chainOf(coneSpec(1, 2));
  std::mt19937_64 random(15);
  for (int trial = 0; trial < 100; ++trial) {
    const glm::dvec3 target = randomPoint(random, 0.9, 1.1);
    IkState attached = reference::restState(chain), plain = attached;
    reference::iterate(chain, {.solver = IkSolver::targetAttached}, target, 0, attached);
    reference::iterate(chain, {.solver = IkSolver::transpose}, target, 0, plain);
    const glm::dvec3 from = reference::restState(chain).joints[1];
    ASSERT_GT(glm::dot(glm::cross(from, attached.joints[1]), glm::cross(from, plain.joints[1])), 0);
  }
}

// How far the bones are beyond cones whose axes are told from the one bone before, as the dissertation does.
double beyondNeighbours(const ChainSpec& spec, const reference::Joints& joints) {
  double worst = 0;
  for (size_t i = 1; i < spec.size(); ++i) {
    const glm::dvec3 u = glm::normalize(joints[i + 1] - joints[i]),
                     before = glm::normalize(joints[i] - joints[i - 1]);
    const glm::dquat turn = glm::rotation(glm::normalize(spec[i - 1].direction), before);
    const glm::dvec3 axis = turn * glm::normalize(spec[i].direction);
    worst = std::max(worst, std::atan2(length(glm::cross(axis, u)), glm::dot(axis, u)) - spec[i].cone);
  }
  return worst;
}

// As the text says, a joint that may not move keeps its place, whatever becomes of its bones.
TEST(Dissertation, keepBreaksBoneLengthsAndEdgeDoesNot) {
  const ChainSpec spec = coneSpec(5, 40 * degree);
  const IkChain chain = chainOf(spec);
  reference::IkRandom random(16);
  double stretched = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const glm::dvec3 target =
        reference::stateAt(chain, reference::randomLegalPose(chain.bones, random)).joints.back();
    const IkResult keep = solve(chain, {.solver = IkSolver::dissertationKeep}, target);
    const IkResult edge = solve(chain, {.solver = IkSolver::dissertationEdge}, target);
    stretched = std::max(stretched, judge(spec, keep.state.joints, rotationsOf(chain, keep.state)).stretch);
    ASSERT_LE(judge(spec, edge.state.joints, rotationsOf(chain, edge.state)).stretch, 1e-12);
    ASSERT_LE(beyondNeighbours(spec, edge.state.joints), 1e-7);  // whose cosines are compared
  }
  EXPECT_GT(stretched, 0.05);
}

TEST(Dissertation, laysAChainStraightTowardWhatIsOutOfReach) {
  const IkChain chain = chainOf(coneSpec(4, 10 * degree));
  const IkResult result = solve(chain, {.solver = IkSolver::dissertationEdge}, {0, -1.5, 0});
  EXPECT_EQ(result.stop, IkStop::unreachable);
  EXPECT_NEAR(length(result.state.joints.back() - glm::dvec3(0, -1, 0)), 0, 1e-12);
}

// Poses of every kind of limit, and a free base that points anywhere.
class Columns : public testing::Test {
 protected:
  Columns() {
    ChainSpec spec = mixedSpec();
    spec.insert(spec.begin(), BoneSpec{});
    chain = chainOf(spec);
  }

  reference::Posture randomPosture() {
    return reference::Posture(chain.bones, reference::randomLegalPose(chain.bones, random));
  }

  IkChain chain;
  reference::IkRandom random{19};
};

TEST_F(Columns, areTheTipsMovementARadian) {
  constexpr double step = 1e-6;
  for (int trial = 0; trial < 100; ++trial) {
    const reference::Posture start = randomPosture();
    const auto joints = reference::columnsAt(start, start.tip());
    for (size_t i = 0; i < joints.size(); ++i)
      for (size_t c = 0; c < joints[i].columns.size(); ++c) {
        auto moved = joints;
        moved[i].columns[c].step = step;
        reference::Posture posture = start;
        reference::applySteps(moved, posture);
        ASSERT_LE(length((posture.tip() - start.tip()) / step - joints[i].columns[c].movement), 1e-5)
            << "bone " << i << ", column " << c << ", tan(theta / 2) " << glm::length(start.swing(i));
      }
  }
}

// Chord steps add up.
TEST_F(Columns, stepsCountFromThePoseOfTheColumns) {
  for (int trial = 0; trial < 100; ++trial) {
    reference::Posture posture = randomPosture();
    auto joints = reference::columnsAt(posture, posture.tip());
    for (reference::JointColumns& joint : joints)
      for (reference::Column& column : joint.columns) column.step = 0.1;
    reference::applySteps(joints, posture);
    const glm::dvec3 once = posture.tip();
    reference::applySteps(joints, posture);
    ASSERT_NEAR(length(posture.tip() - once), 0, 1e-12);
  }
}

// The crowd's active set is this one with chord steps; near the target and asked to, it draws the chain to
// rest.
TEST(ActiveSet, restPullUnbendsAChainThatIsOnTarget) {
  const ChainSpec spec = mixedSpec();
  const IkChain chain = chainOf(spec);
  reference::IkRandom random(17);
  IkState state = reference::stateAt(chain, reference::randomLegalPose(chain.bones, random));
  const glm::dvec3 target = state.joints.back();
  const auto bent = [&] {
    double sum = 0;
    for (const glm::dvec2& swing : state.pose.swing) sum += glm::dot(swing, swing);
    return sum;
  };
  const double before = bent();
  IkSettings settings{.solver = IkSolver::activeSet};
  for (int k = 0; k < 100; ++k) reference::iterate(chain, settings, target, k, state);
  EXPECT_NEAR(bent(), before, 1e-6);
  settings.restPull = 0.05;
  for (int k = 0; k < 300; ++k) {
    reference::iterate(chain, settings, target, k, state);
    ASSERT_LE(state.error(target), 2e-3);
    ASSERT_LE(judge(spec, state.joints, rotationsOf(chain, state)).beyond, 1e-9);
  }
  EXPECT_LT(bent(), 0.9 * before);
}

}  // namespace
}  // namespace skitter::test

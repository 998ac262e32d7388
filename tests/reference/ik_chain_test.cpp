#include "cpu_reference/ik/chain.h"

#include <gtest/gtest.h>

#include <limits>

#include "cpu_reference/ik/seeds.h"
#include "cpu_reference/rotation.h"
#include "ik_chains.h"

namespace skitter::test {
namespace {

using reference::IkChain;
using reference::LimitKind;
using reference::Pose;
using reference::Posture;

// By hand: swings of 90 degrees are (X, Y) of length 1, a hinge at q has Y = -tan(q / 2).
struct ByHand {
  const char* name;
  ChainSpec spec;
  Pose pose;
  std::vector<glm::dvec3> joints;
};

void PrintTo(const ByHand& c, std::ostream* out) { *out << c.name; }

BoneSpec along(const glm::dvec3& direction, LimitKind kind = LimitKind::cone) {
  BoneSpec bone;
  bone.direction = direction;
  bone.kind = kind;
  bone.cone = 3;
  bone.low = -3;
  bone.high = 3;
  bone.twist = kind == LimitKind::hinge ? std::nullopt : std::optional(std::pair(-3.0, 3.0));
  return bone;
}

class ForwardKinematics : public testing::TestWithParam<ByHand> {};

TEST_P(ForwardKinematics, placesJointsWhereTheyAreByHand) {
  const IkChain chain = chainOf(GetParam().spec);
  const Posture posture(chain.bones, GetParam().pose);
  for (size_t i = 0; i < GetParam().joints.size(); ++i) {
    EXPECT_NEAR(glm::length(posture.joint(i) - GetParam().joints[i]), 0, 1e-12) << "joint " << i;
  }
}

const double half = std::sqrt(0.75);
INSTANTIATE_TEST_SUITE_P(
    byHand, ForwardKinematics,
    testing::Values(
        ByHand{"rest",
               {along({1, 0, 0}), along({0, -1, 0})},
               Pose::rest(2),
               {{0, 0, 0}, {.5, 0, 0}, {.5, -.5, 0}}},
        ByHand{"swing",
               {along({0, 0, 1}), along({0, 0, 1})},
               {{{1, 0}, {0, 0}}, {0, 0}},
               {{0, 0, 0}, {.5, 0, 0}, {1, 0, 0}}},
        ByHand{"swingTwice",
               {along({0, 0, 1}), along({0, 0, 1})},
               {{{1, 0}, {1, 0}}, {0, 0}},
               {{0, 0, 0}, {.5, 0, 0}, {.5, 0, -.5}}},
        ByHand{"swingAside",
               {along({0, 0, 1}), along({0, 0, 1})},
               {{{1, 0}, {0, 1}}, {0, 0}},
               {{0, 0, 0}, {.5, 0, 0}, {.5, .5, 0}}},
        ByHand{"twist",
               {along({0, 0, 1}), along({1, 0, 0})},
               {{{0, 0}, {0, 0}}, {1, 0}},
               {{0, 0, 0}, {0, 0, .5}, {0, .5, .5}}},
        ByHand{"swingAndTwist",
               {along({0, 0, 1}), along({1, 0, 0})},
               {{{1, 0}, {0, 0}}, {1, 0}},
               {{0, 0, 0}, {.5, 0, 0}, {.5, .5, 0}}},
        ByHand{"frameOfX", {along({1, 0, 0})}, {{{1, 0}}, {0}}, {{0, 0, 0}, {0, 0, -1}}},
        ByHand{"frameAgainstZ", {along({0, 0, -1})}, {{{1, 0}}, {0}}, {{0, 0, 0}, {1, 0, 0}}},
        ByHand{"hinge", {along({1, 0, 0}, LimitKind::hinge)}, {{{0, -1}}, {0}}, {{0, 0, 0}, {0, 1, 0}}},
        ByHand{"hingeBack", {along({1, 0, 0}, LimitKind::hinge)}, {{{0, 1}}, {0}}, {{0, 0, 0}, {0, -1, 0}}},
        ByHand{"skewHinge",
               {along({half, 0, 0.5}, LimitKind::hinge)},
               {{{0, -1}}, {0}},
               {{0, 0, 0}, {0, half, 0.5}}},
        ByHand{"hingeCarriesOn",
               {along({1, 0, 0}, LimitKind::hinge), along({0, 0, 1}), along({1, 0, 0})},
               {{{0, -1}, {0, 0}, {0, 0}}, {0, 0, 0}},
               {{0, 0, 0}, {0, 1 / 3., 0}, {0, 1 / 3., 1 / 3.}, {0, 2 / 3., 1 / 3.}}}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(IkChain, untwistedBallsTurnByTheShortestArc) {
  const ChainSpec spec = coneSpec(6, 2.5);
  const IkChain chain = chainOf(spec);
  reference::IkRandom random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const auto state = reference::stateAt(chain, reference::randomLegalPose(chain.bones, random));
    const auto byPose = reference::rotationsOf(chain, state.pose);
    const auto byJoints = reference::rotationsOf(chain, state.joints);
    for (size_t i = 0; i < 6; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_NEAR(glm::length(byPose[i][axis] - byJoints[i][axis]), 0, 1e-9) << trial << " bone " << i;
      }
    }
  }
}

TEST(IkChain, framesAreRightHandedAndHoldTheBone) {
  for (const ChainSpec& spec : {coneSpec(5, 1), hingeSpec(5), mixedSpec()}) {
    const IkChain chain = chainOf(spec);
    double length = 0;
    for (size_t i = 0; i < spec.size(); ++i) {
      const auto& bone = chain.bones[i];
      EXPECT_NEAR(glm::determinant(bone.frame), 1, 1e-12);
      EXPECT_NEAR(glm::length(bone.direction() - glm::normalize(spec[i].direction)), 0, 1e-12);
      length += bone.length;
    }
    EXPECT_NEAR(length, 1, 1e-12);
  }
}

TEST(IkChain, isFreeIfNoBoneIsLimited) {
  ChainSpec spec = bentSpec(4);
  EXPECT_TRUE(chainOf(spec).free);
  spec[2].twist = {-0.1, 0.1};
  EXPECT_FALSE(chainOf(spec).free);
  EXPECT_FALSE(chainOf(hingeSpec(2)).free);
  EXPECT_FALSE(chainOf(coneSpec(1, 3.1)).free);
}

TEST(IkChain, refusesWhatIsNoChain) {
  using reference::IkBone, reference::makeIkChain;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(makeIkChain({}), std::invalid_argument);
  EXPECT_THROW(makeIkChain(std::vector<IkBone>(16, {.length = 1})), std::invalid_argument);
  EXPECT_NO_THROW(makeIkChain(std::vector<IkBone>(15, {.length = 1})));
  EXPECT_THROW(makeIkChain({{.length = 0}, {.length = 0}}), std::invalid_argument);
  EXPECT_THROW(makeIkChain({{.length = 1}, {.length = -1}}), std::invalid_argument);
  EXPECT_THROW(makeIkChain({{.length = nan}}), std::invalid_argument);
  EXPECT_THROW(makeIkChain({{.length = 1, .direction = {0, 0, 0}}}), std::invalid_argument);
  EXPECT_THROW(makeIkChain({{.length = 1}}, glm::dvec3(0)), std::invalid_argument);
  IkBone hinge{
      .length = 1, .direction = {0, 0.04, 1}, .limit = reference::hingeLimit(-1, 1), .hingeAxis = {0, 0, 2}};
  EXPECT_THROW(makeIkChain({hinge}), std::invalid_argument);
  hinge.direction.y = 0.05;
  EXPECT_NO_THROW(makeIkChain({hinge}));
  EXPECT_THROW(reference::coneLimit(0), std::invalid_argument);
  EXPECT_THROW(reference::coneLimit(nan), std::invalid_argument);
  EXPECT_THROW(reference::ellipseLimit(1, 1, 0, 1), std::invalid_argument);
  EXPECT_THROW(reference::hingeLimit(1, -1), std::invalid_argument);
  EXPECT_THROW(reference::hingeLimit(nan, 1), std::invalid_argument);
  EXPECT_THROW(reference::withTwist(reference::coneLimit(1), 1, 0.5), std::invalid_argument);
}

// Any pose at all, most of it far outside.
Pose anyPose(size_t bones, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0, 2);
  Pose pose = Pose::rest(bones);
  for (size_t i = 0; i < bones; ++i) {
    pose.swing[i] = {normal(random), normal(random)};
    pose.twist[i] = normal(random);
  }
  return pose;
}

TEST(IkLimits, clampedPosesAreLegalAndTheLimitIsReached) {
  std::mt19937_64 random(2);
  for (const ChainSpec& spec :
       {coneSpec(4, 1), coneSpec(4, 2.6), ellipseSpec(4), hingeSpec(4), mixedSpec()}) {
    const IkChain chain = chainOf(spec);
    for (int trial = 0; trial < 400; ++trial) {
      const Pose pose = anyPose(spec.size(), random);
      const auto state = reference::stateAt(chain, pose);
      const Verdict verdict = judge(spec, state.joints, rotationsOf(chain, state));
      ASSERT_LE(verdict.beyond, 1e-9);
      ASSERT_LE(verdict.rotation, 1e-9);
      ASSERT_LE(verdict.stretch, 1e-12);
      // Only what is outside is moved, and no further than to the limit: a little more is outside again.
      const Pose again = reference::clamped(chain.bones, state.pose);
      for (size_t i = 0; i < spec.size(); ++i) {
        ASSERT_NEAR(glm::length(again.swing[i] - state.pose.swing[i]), 0, 1e-12);
        if (state.pose.swing[i] == pose.swing[i] || spec[i].kind == LimitKind::hinge) continue;
        Pose out = state.pose;
        out.swing[i] *= 1 + 1e-6;
        const auto joints = Posture(chain.bones, out).joints();
        ASSERT_GT(judge(spec, joints, reference::rotationsOf(chain, out)).beyond, 1e-8) << "bone " << i;
      }
    }
  }
}

TEST(IkLimits, straightAgainstTheRestDirectionEveryWayIsAsGood) {
  const reference::Limit cone = reference::coneLimit(1), narrow = reference::coneLimit(4e-4);
  EXPECT_EQ(reference::clampSwing(cone, {3e3, 4e3}), glm::dvec2(std::tan(0.5), 0));
  EXPECT_EQ(reference::clampSwing(reference::ellipseLimit(1, 2, 1, 2), {0, 1e9}),
            glm::dvec2(std::tan(0.5), 0));
  // A narrow cone has no such pole near rest.
  EXPECT_NEAR(reference::clampSwing(narrow, {0, 3e-4}).y, std::tan(2e-4), 1e-15);
  EXPECT_EQ(reference::clampSwing(narrow, {0, 0}), glm::dvec2(0));
}

TEST(IkLimits, ellipseHasItsFourHalfAngles) {
  const reference::Limit limit = reference::ellipseLimit(0.3, 0.7, 0.4, 0.2);
  EXPECT_NEAR(reference::clampSwing(limit, {1, 0}).x, std::tan(0.15), 1e-15);
  EXPECT_NEAR(reference::clampSwing(limit, {0, 1}).y, std::tan(0.35), 1e-15);
  EXPECT_NEAR(reference::clampSwing(limit, {-1, 0}).x, -std::tan(0.2), 1e-15);
  EXPECT_NEAR(reference::clampSwing(limit, {0, -1}).y, -std::tan(0.1), 1e-15);
}

TEST(Rotation, shortestTurnsOneOntoTheOther) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 300; ++trial) {
    const glm::dvec3 a = randomPoint(random, 1, 1);
    const glm::dvec3 b =
        trial % 3 == 0 ? glm::normalize(-a + 1e-5 * randomPoint(random, 0, 1)) : randomPoint(random, 1, 1);
    const glm::dmat3 turn = reference::shortest(a, b);
    ASSERT_NEAR(glm::length(turn * a - b), 0, trial % 3 == 0 ? 2e-3 : 1e-9);
    ASSERT_NEAR(glm::determinant(turn), 1, 1e-6);
    if (trial % 3 == 0) continue;
    ASSERT_NEAR(glm::length(turn * glm::cross(a, b) - glm::cross(a, b)), 0, 1e-12);
  }
  EXPECT_EQ(reference::shortest(glm::dvec3(0), glm::dvec3(1, 0, 0)), glm::dmat3(1));
}

}  // namespace
}  // namespace skitter::test

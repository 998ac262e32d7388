#include "validation/ik_judge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

// The judge of poses, held against poses made by hand: where the answer is known without propagating frames.
namespace skitter::test {
namespace {

using glm::dquat;
using glm::dvec3;
using validation::IkJudge;
namespace judged = validation::judged;
using Joints = std::vector<dvec3>;

constexpr double kRounding = 1e-9;
const dvec3 X(1, 0, 0), Y(0, 1, 0), Z(0, 0, 1);

double rad(double degrees) { return glm::radians(degrees); }

// Unit vector at `degrees` from `from` toward `toward`, which is square to it.
dvec3 leaning(const dvec3& from, const dvec3& toward, double degrees) {
  return std::cos(rad(degrees)) * from + std::sin(rad(degrees)) * toward;
}

IkJudge::Bone bone(const dvec3& rest, judged::Limit limit = judged::Free{}, double length = 1) {
  return {length, rest, limit, 0, 0};
}
judged::Cone cone(double degrees) { return {rad(degrees)}; }
judged::Hinge hinge(const dvec3& axis, double min, double max) { return {axis, rad(min), rad(max)}; }

// Joints of a chain of unit bones with these directions.
Joints posed(const std::vector<dvec3>& directions) {
  Joints joints = {dvec3(0)};
  for (const dvec3& direction : directions) joints.push_back(joints.back() + direction);
  return joints;
}

double violation(const std::vector<IkJudge::Bone>& bones, const std::vector<dvec3>& directions) {
  const Joints joints = posed(directions);
  const IkJudge::Verdict verdict = IkJudge(bones).judge(joints.back(), joints);
  EXPECT_NEAR(verdict.tipError, 0, kRounding);
  EXPECT_NEAR(verdict.boneLengthError, 0, kRounding);
  return verdict.limitViolation;
}

TEST(IkJudge, RestPoseIsLegalUnderEveryLimit) {
  const dvec3 oblique = glm::normalize(dvec3(0.3, 0.8, -0.5));
  EXPECT_NEAR(violation({bone(oblique, cone(1)), bone(Y, judged::Ellipse{0.1, 0.2, 0.3, 0.4}),
                         bone(oblique, hinge(dvec3(0, 0, 5), -1, 1)), bone(-Z, cone(1)), bone(X)},
                        {oblique, Y, oblique, -Z, X}),
              0, kRounding);
}

TEST(IkJudge, TipErrorIsAShareOfTheLength) {
  const IkJudge judge({bone(X, {}, 3), bone(Y, {}, 1)});
  const Joints joints = {dvec3(0), dvec3(3, 0, 0), dvec3(3, 1, 0)};
  EXPECT_NEAR(judge.judge({3, 1, 0.4}, joints).tipError, 0.1, kRounding);
  EXPECT_EQ(judge.judge({3, 1, 0}, joints).tipError, 0);
}

TEST(IkJudge, BoneLengths) {
  const IkJudge judge({bone(X, {}, 1), bone(X, {}, 0), bone(X, {}, 3)});
  EXPECT_NEAR(judge.judge(X, Joints{dvec3(0), X, X, 4.0 * X}).boneLengthError, 0, kRounding);
  EXPECT_NEAR(judge.judge(X, Joints{dvec3(0), X, X, 4.4 * X}).boneLengthError, 0.1, kRounding);
  EXPECT_NEAR(judge.judge(X, Joints{dvec3(0), 0.8 * X, 0.8 * X, 3.8 * X}).boneLengthError, 0.05, kRounding);
  EXPECT_NEAR(judge.judge(X, Joints{dvec3(0), X, 1.2 * X, 4.2 * X}).boneLengthError, 0.05, kRounding);
  EXPECT_NEAR(judge.judge(X, Joints{0.4 * Y, X + 0.4 * Y, X + 0.4 * Y, 4.0 * X + 0.4 * Y}).boneLengthError,
              0.1, kRounding)
      << "a base that left its place";
}

TEST(IkJudge, ConeJustLegalAndJustNot) {
  const std::vector<IkJudge::Bone> bones = {bone(Y), bone(Y, cone(30))};
  for (const dvec3& side : {X, -X, Z, -Z, glm::normalize(dvec3(1, 0, -1))}) {
    EXPECT_EQ(violation(bones, {Y, leaning(Y, side, 29.99)}), 0);
    EXPECT_NEAR(violation(bones, {Y, leaning(Y, side, 30.01)}), rad(0.01), kRounding);
  }
  EXPECT_NEAR(violation(bones, {Y, leaning(Y, X, 1e-6)}), 0, kRounding);
  EXPECT_EQ(violation({bone(Y), bone(Y, cone(0.001))}, {Y, Y}), 0) << "straight";
}

TEST(IkJudge, ConeIsCarriedAlong) {
  const std::vector<IkJudge::Bone> bones = {bone(Y), bone(Y, cone(30))};
  EXPECT_EQ(violation(bones, {X, leaning(X, Z, 29.99)}), 0);
  EXPECT_NEAR(violation(bones, {X, Y}), rad(60), kRounding);
}

TEST(IkJudge, StraightAgainstTheRestDirection) {
  EXPECT_NEAR(violation({bone(Y), bone(Y, cone(30))}, {Y, -Y}), rad(150), kRounding);
  EXPECT_NEAR(violation({bone(Z, cone(90))}, {-Z}), rad(90), kRounding);
  EXPECT_NEAR(violation({bone(Z, judged::Ellipse{1, 2, 3, 1})}, {-Z}), rad(180) - 1, kRounding);
  EXPECT_NEAR(violation({bone(Y, hinge(Z, -10, 20))}, {-Y}), rad(160), kRounding);
  EXPECT_EQ(violation({bone(Y)}, {-Y}), 0) << "free";
  EXPECT_NEAR(violation({bone(Z), bone(Y, cone(1))}, {-Z, -Y}), 0, kRounding) << "a half turn is about x";
  EXPECT_NEAR(violation({bone(Z, cone(180))}, {-Z}), rad(180) - 3.1, kRounding) << "cones end at 3.1";
}

// A bone of which two points show the direction but not the roll: the third bone hangs on it.
TEST(IkJudge, RollComesFromEveryBoneBefore) {
  const std::vector<IkJudge::Bone> bones = {bone(Z), bone(X, cone(1)), bone(Y, cone(1))};
  // Z to X turns about Y by 90 degrees and takes X to -Z.
  EXPECT_NEAR(violation(bones, {X, -Z, Y}), 0, kRounding);
  EXPECT_NEAR(violation(bones, {X, X, X}), rad(89), 1e-6);
  // Then -Z to Y turns about X by 90 degrees and takes Y to Z.
  const std::vector<IkJudge::Bone> wide = {bone(Z), bone(X, cone(91)), bone(Y, cone(1))};
  EXPECT_NEAR(violation(wide, {X, Y, Z}), 0, kRounding);
  EXPECT_NEAR(violation(wide, {X, Y, -X}), rad(89), kRounding);
}

TEST(IkJudge, EllipseHasAnAngleAQuadrant) {
  const judged::Ellipse ellipse{rad(40), rad(70), rad(30), rad(20)};
  const std::vector<IkJudge::Bone> bones = {bone(Z, ellipse)};
  const struct {
    dvec3 side;
    double degrees;
  } ends[] = {{X, 40}, {Y, 70}, {-X, 30}, {-Y, 20}};
  for (const auto& end : ends) {
    EXPECT_EQ(violation(bones, {leaning(Z, end.side, end.degrees - 0.01)}), 0);
    EXPECT_NEAR(violation(bones, {leaning(Z, end.side, end.degrees + 0.01)}), rad(0.01), kRounding);
  }
  const double between = 1 / std::sqrt(0.5 / (40.0 * 40) + 0.5 / (20.0 * 20));
  const dvec3 diagonal = glm::normalize(X - Y);
  EXPECT_EQ(violation(bones, {leaning(Z, diagonal, between - 0.01)}), 0);
  EXPECT_NEAR(violation(bones, {leaning(Z, diagonal, between + 0.01)}), rad(0.01), kRounding);
}

// For a bone along Y, x is X and y is -Z; for one along -Z, x is X and y is -Y.
TEST(IkJudge, EllipseLiesInTheFrameAtRest) {
  const judged::Ellipse ellipse{rad(40), rad(70), rad(30), rad(20)};
  EXPECT_NEAR(violation({bone(Y, ellipse)}, {leaning(Y, -Z, 71)}), rad(1), kRounding);
  EXPECT_NEAR(violation({bone(Y, ellipse)}, {leaning(Y, Z, 21)}), rad(1), kRounding);
  EXPECT_NEAR(violation({bone(Y, ellipse)}, {leaning(Y, X, 41)}), rad(1), kRounding);
  EXPECT_NEAR(violation({bone(-Z, ellipse)}, {leaning(-Z, -Y, 71)}), rad(1), kRounding);
  EXPECT_NEAR(violation({bone(-Z, ellipse)}, {leaning(-Z, -X, 31)}), rad(1), kRounding);
}

TEST(IkJudge, HingeTurnsRightHandedAboutItsAxis) {
  const std::vector<IkJudge::Bone> bones = {bone(Y, hinge(Z, -30, 90))};
  EXPECT_EQ(violation(bones, {leaning(Y, -X, 89.99)}), 0);
  EXPECT_NEAR(violation(bones, {leaning(Y, -X, 90.01)}), rad(0.01), kRounding);
  EXPECT_EQ(violation(bones, {leaning(Y, X, 29.99)}), 0);
  EXPECT_NEAR(violation(bones, {leaning(Y, X, 30.01)}), rad(0.01), kRounding);
  EXPECT_NEAR(violation(bones, {leaning(leaning(Y, -X, 45), Z, 5)}), rad(5), kRounding) << "out of its plane";
}

TEST(IkJudge, HingeRangesAreOnACircle) {
  const std::vector<IkJudge::Bone> bones = {bone(Y, hinge(Z, -10, 170))};
  EXPECT_NEAR(violation(bones, {leaning(Y, -X, 190)}), rad(20), kRounding);
  EXPECT_NEAR(violation(bones, {leaning(Y, -X, 260)}), rad(90), kRounding);
  EXPECT_NEAR(violation(bones, {leaning(Y, -X, 345)}), rad(5), kRounding);
}

// 45 degrees from its axis, the bone sweeps a cone; what hangs on it turns by the whole angle, not by the
// shortest arc between the bone's directions.
TEST(IkJudge, ObliqueHingeTurnsFully) {
  const dvec3 rest = glm::normalize(Y + Z), turned = glm::normalize(-X + Z);
  const std::vector<IkJudge::Bone> bones = {bone(rest, hinge(Z, -100, 100)), bone(X, cone(1))};
  EXPECT_NEAR(violation(bones, {turned, Y}), 0, kRounding);
  const dvec3 axis = glm::normalize(glm::cross(rest, turned));
  const dvec3 shortest = glm::angleAxis(std::acos(glm::dot(rest, turned)), axis) * X;
  EXPECT_GT(violation(bones, {turned, shortest}), rad(10));
  EXPECT_NEAR(violation(bones, {Y, X}), rad(45), kRounding) << "off the cone that it sweeps";
}

TEST(IkJudge, BonesWithoutLengthTurnNothing) {
  const std::vector<IkJudge::Bone> bones = {bone(X, cone(5), 0), bone(Y, cone(5)), bone(Z, cone(5), 0)};
  const IkJudge judge(bones);
  EXPECT_EQ(judge.judge(Y, Joints{dvec3(0), dvec3(0), Y, Y}).limitViolation, 0);
  EXPECT_NEAR(judge.judge(Y, Joints{dvec3(0), dvec3(0), leaning(Y, Z, 7), leaning(Y, Z, 7)}).limitViolation,
              rad(2), kRounding);
  EXPECT_NEAR(judge.judge(Y, Joints{dvec3(0), 0.01 * Z, Y + 0.01 * Z, Y}).limitViolation, 0, kRounding)
      << "where they point says nothing";
}

TEST(IkJudge, CollapsedBoneHasNoDirectionButAWrongLength) {
  const IkJudge judge({bone(X, cone(5)), bone(X, cone(5))});
  const IkJudge::Verdict verdict = judge.judge(X, Joints{dvec3(0), dvec3(0), X});
  EXPECT_EQ(verdict.limitViolation, 0);
  EXPECT_NEAR(verdict.boneLengthError, 0.5, kRounding);
  EXPECT_NEAR(judge.judge(X, Joints{dvec3(0), dvec3(0), Y}).limitViolation, rad(85), kRounding)
      << "the next one";
}

TEST(IkJudge, WhatIsNotFiniteErrsInfinitely) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = HUGE_VAL;
  const IkJudge judge({bone(X, cone(5)), bone(X, cone(5))});
  for (const double broken : {nan, inf, -inf}) {
    const IkJudge::Verdict verdict = judge.judge(X, Joints{dvec3(0), dvec3(1, broken, 0), 2.0 * X});
    EXPECT_EQ(verdict.tipError, inf);
    EXPECT_EQ(verdict.limitViolation, inf);
    EXPECT_EQ(verdict.boneLengthError, inf);
    EXPECT_EQ(judge.judge({broken, 0, 0}, Joints{dvec3(0), X, 2.0 * X}).tipError, inf);
  }
}

TEST(IkJudge, RefusesWhatDoesNotMatch) {
  EXPECT_THROW(IkJudge({bone(X, {}, 0)}), std::invalid_argument);
  EXPECT_THROW(IkJudge({}), std::invalid_argument);
  const IkJudge judge({bone(X), bone(X)});
  EXPECT_THROW(judge.judge(X, Joints{dvec3(0), X}), std::invalid_argument);
  const std::vector<dquat> one(1, dquat(1, 0, 0, 0));
  EXPECT_THROW(judge.judge(X, Joints{dvec3(0), X, X}, one), std::invalid_argument);
}

struct TwistedBone : testing::Test {
  IkJudge judge{{{1, Y, judged::Cone{rad(50)}, rad(-30), rad(60)}, bone(Y, cone(30))}};

  // The first bone leans to X by 40 degrees and is twisted; the second follows it, leaning a little more.
  IkJudge::Verdict twisted(double twist, double more = 0) const {
    const dquat swing = glm::angleAxis(rad(-40), Z);
    const dquat first = swing * glm::angleAxis(rad(twist), Y);
    const dquat second = first * glm::angleAxis(rad(more), X);
    const Joints joints = {dvec3(0), first * Y, first * Y + second * Y};
    return judge.judge(joints.back(), joints, std::vector<dquat>{first, second});
  }
};

TEST_F(TwistedBone, NeedsRotations) {
  EXPECT_TRUE(judge.needsRotations());
  EXPECT_THROW(judge.judge(Y, Joints{dvec3(0), Y, 2.0 * Y}), std::invalid_argument);
  EXPECT_FALSE(IkJudge({bone(Y, cone(5))}).needsRotations());
}

TEST_F(TwistedBone, TwistWithinItsRange) {
  EXPECT_NEAR(twisted(59.99).limitViolation, 0, kRounding);
  EXPECT_NEAR(twisted(60.01).limitViolation, rad(0.01), kRounding);
  EXPECT_NEAR(twisted(-29.99).limitViolation, 0, kRounding);
  EXPECT_NEAR(twisted(-31).limitViolation, rad(1), kRounding);
  EXPECT_NEAR(twisted(10, 31).limitViolation, rad(1), kRounding) << "the next bone, in the twisted frame";
}

TEST_F(TwistedBone, RotationsMustFitTheJoints) {
  const std::vector<dquat> rest(2, dquat(1, 0, 0, 0));
  const dvec3 tilted = leaning(Y, Z, 3);
  EXPECT_NEAR(judge.judge(Y, Joints{dvec3(0), tilted, tilted + Y}, rest).limitViolation, rad(3), kRounding);
}

TEST_F(TwistedBone, BonesWithoutARangeMayNotTwist) {
  const IkJudge plain({bone(Y, cone(5)), bone(X, hinge(Z, -5, 5))});
  const Joints joints = {dvec3(0), Y, Y + X};
  const dquat none(1, 0, 0, 0), twist = glm::angleAxis(rad(2), Y);
  EXPECT_NEAR(plain.judge(Y, joints, std::vector<dquat>{none, none}).limitViolation, 0, kRounding);
  EXPECT_NEAR(plain.judge(Y, joints, std::vector<dquat>{none, glm::angleAxis(rad(2), X)}).limitViolation,
              rad(2), kRounding)
      << "a hinge turned about its bone";
  EXPECT_NEAR(plain.judge(Y, joints, std::vector<dquat>{twist, none}).limitViolation, rad(2), kRounding);
}

TEST_F(TwistedBone, ChainsWithoutLimitsMayDoAnything) {
  const IkJudge free({bone(Y), bone(X)});
  const dquat twist = glm::angleAxis(rad(50), Y);
  const Joints joints = {dvec3(0), Y, Y + twist * X};
  EXPECT_NEAR(free.judge(Y, joints, std::vector<dquat>{twist, twist}).limitViolation, 0, kRounding);
}

// Turns composed at random, each within its bone's limit: legal by joints and by rotations alike.
TEST(IkJudge, JointsAndRotationsGiveTheSameVerdict) {
  std::mt19937_64 random(7);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto direction = [&] {
    return glm::normalize(dvec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)));
  };
  for (int trial = 0; trial < 2000; ++trial) {
    const double excess = trial % 2 == 0 ? 0 : uniform(0.01, 0.2);
    std::vector<IkJudge::Bone> bones;
    std::vector<dquat> rotations;
    Joints joints = {dvec3(0)};
    dquat carried(1, 0, 0, 0);
    for (int i = 0; i < 6; ++i) {
      const dvec3 rest = direction();
      dvec3 axis = direction();
      if (std::abs(glm::dot(axis, rest)) > 0.9) axis = glm::normalize(glm::cross(axis, rest));
      const double angle = uniform(0.1, 2), turned = i == 3 ? angle + excess : uniform(0, angle);
      if (i % 2 == 0) {
        bones.push_back(bone(rest, judged::Hinge{axis, -0.5, angle}));
        carried = carried * glm::angleAxis(turned, axis);
      } else {
        bones.push_back(bone(rest, judged::Cone{angle}));
        carried = carried * glm::angleAxis(turned, glm::normalize(glm::cross(rest, axis)));
      }
      rotations.push_back(carried);
      joints.push_back(joints.back() + carried * rest);
    }
    const IkJudge judge(bones);
    EXPECT_NEAR(judge.judge(joints.back(), joints).limitViolation, excess, 1e-7);
    EXPECT_NEAR(judge.judge(joints.back(), joints, rotations).limitViolation, excess, 1e-7);
  }
}

}  // namespace
}  // namespace skitter::test

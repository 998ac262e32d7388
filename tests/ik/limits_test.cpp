// Limits as the host has them: greatest angles, clamping, twists.
#include "ik/limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "ik/skeleton.h"

namespace skitter::test {
namespace {

constexpr ik::Ellipse uneven{.px = 0.5f, .py = 1, .nx = 0.8f, .ny = 1.6f};

TEST(Limits, AnEllipseHasAnAngleToEachSide) {
  constexpr double quarter = std::numbers::pi / 2;
  EXPECT_NEAR(ik::greatestAngle(uneven, 0), 0.5, 1e-6);
  EXPECT_NEAR(ik::greatestAngle(uneven, quarter), 1, 1e-6);
  EXPECT_NEAR(ik::greatestAngle(uneven, 2 * quarter), 0.8, 1e-6);
  EXPECT_NEAR(ik::greatestAngle(uneven, -quarter), 1.6, 1e-6);
  for (double phi = -3; phi < 3; phi += 0.1) {
    const double angle = ik::greatestAngle(uneven, phi), x = angle * std::cos(phi), y = angle * std::sin(phi);
    EXPECT_NEAR(std::hypot(x / (x < 0 ? 0.8 : 0.5), y / (y < 0 ? 1.6 : 1)), 1, 1e-6) << phi;
  }
}

TEST(Limits, AConeHasOneAngleAndABallTheWidest) {
  for (const double phi : {-2.0, 0.0, 1.0}) {
    EXPECT_NEAR(ik::greatestAngle(ik::Cone{0.7f}, phi), 0.7, 1e-6);
    EXPECT_EQ(ik::greatestAngle(ik::Free{}, phi), ik::widestAngle);
  }
}

TEST(Limits, WhatIsBeyondThemIsClampedTowardRest) {
  for (double phi = -3; phi < 3; phi += 0.1) {
    const double most = ik::greatestAngle(uneven, phi);
    const glm::dvec3 inside = ik::leaning(0.9 * most, phi), outside = ik::leaning(1.1 * most, phi);
    EXPECT_EQ(ik::clamped(uneven, inside), inside) << phi;
    EXPECT_LT(glm::distance(ik::clamped(uneven, outside), ik::leaning(most, phi)), 1e-9) << phi;
  }
  const ik::Hinge knee{.axis = {1, 0, 0}, .min = -0.2f, .max = 1};
  EXPECT_LT(glm::distance(ik::clamped(knee, {0, -std::sin(2.0), std::cos(2.0)}),
                          {0, -std::sin(1.0), std::cos(1.0)}),
            1e-6);
  EXPECT_LT(glm::distance(ik::clamped(knee, {0.3, std::sin(0.1), std::cos(0.1)}),
                          {0, std::sin(0.1), std::cos(0.1)}),
            1e-6);
}

// A chain has twists where one bone may twist, if only to one side.
TEST(Limits, ATwistToOneSideIsOne) {
  ik::Chain chain{.bones = std::vector<ik::Bone>(3, {.length = 1, .limit = ik::Cone{1}}), .pole = {}};
  EXPECT_FALSE(ik::Skeleton(chain).hasTwists());
  chain.bones[1].twistMax = 0.4f;
  EXPECT_TRUE(ik::Skeleton(chain).hasTwists());
  chain.bones[1].twistMax = 0;
  chain.bones[2].twistMin = -0.4f;
  EXPECT_TRUE(ik::Skeleton(chain).hasTwists());
}

}  // namespace
}  // namespace skitter::test

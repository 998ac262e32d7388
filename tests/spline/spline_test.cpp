// Splines on the host: closed forms, the reference, and travelling by the clock.
#include "skitter/spline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "spline/runs.h"

namespace skitter::test {
namespace {

using glm::vec3;

// Halfs and small integers, so that float32 holds points and tangents exactly.
vec3 cubic(float t) { return {1 + t - 2 * t * t + t * t * t, 3 - t * t * t, 0.5f * t * t}; }
vec3 cubicVelocity(float t) { return {1 - 4 * t + 3 * t * t, -3 * t * t, t}; }
vec3 cubicAcceleration(float t) { return {-4 + 6 * t, -6 * t, 1}; }

SplineChain cubicChain() {
  SplineChain chain{.knots = {-1, -0.5f, 0.5f, 2}, .tangents = {SplineRule::given}};
  for (const float t : chain.knots) {
    chain.points.push_back(cubic(t));
    chain.arriving.push_back(cubicVelocity(t));
  }
  return chain;
}

TEST(Spline, ACubicIsKeptWithItsDerivatives) {
  const Spline spline(cubicChain());
  for (float t = -1; t <= 2; t += 0.0625f) {
    EXPECT_LT(glm::distance(spline.position(t), cubic(t)), 1e-6f) << t;
    EXPECT_LT(glm::distance(spline.velocity(t), cubicVelocity(t)), 2e-6f) << t;
    EXPECT_LT(glm::distance(spline.acceleration(t), cubicAcceleration(t)), 2e-6f) << t;
  }
  EXPECT_EQ(spline.position(-7), cubic(-1));
  EXPECT_EQ(spline.position(7), cubic(2));
}

TEST(Spline, LengthOfALineAndOfAParabola) {
  const std::vector<vec3> inLine = {{0, 0, 0}, {1, 2, 2}, {2, 4, 4}};
  EXPECT_NEAR(Spline({.points = inLine}).length(), 6, 1e-14);
  // Uneven knots: it speeds up and slows down, but never turns back.
  const Spline line({.points = inLine, .knots = {0, 1, 5}, .tangents = {SplineRule::monotone}});
  EXPECT_NEAR(line.length(), 6, 1e-14);
  EXPECT_NEAR(line.timeAtLength(3), 1, 1e-11);
  const Spline parabola({.points = {{0, 0, 0}, {1, 1, 0}},
                         .tangents = {SplineRule::given},
                         .arriving = {{1, 0, 0}, {1, 2, 0}}});
  EXPECT_NEAR(parabola.length(), 0.5 * std::sqrt(5) + 0.25 * std::asinh(2), 1e-12);
  for (const double x : {0.1, 0.4, 0.9})
    EXPECT_NEAR(parabola.lengthAt(x), 0.5 * x * std::sqrt(1 + 4 * x * x) + 0.25 * std::asinh(2 * x), 1e-12);
}

TEST(Spline, ARoundOfACircle) {
  const auto m = static_cast<float>(4 * (std::numbers::sqrt2 - 1));
  const Spline circle({.points = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
                       .closed = true,
                       .tangents = {SplineRule::given},
                       .arriving = {{0, m, 0}, {-m, 0, 0}, {0, -m, 0}, {m, 0, 0}}});
  for (double t = -4; t < 8; t += 0.01) EXPECT_NEAR(glm::length(circle.position(t)), 1, 2.74e-4);
  EXPECT_NEAR(circle.length(), 2 * std::numbers::pi, 1e-3);
  EXPECT_LT(glm::distance(circle.position(5.5), circle.position(1.5)), 1e-7f);
}

TEST(Spline, IsTheReferences) {
  uint64_t seed = 10;
  for (const SplineRule rule : allSplineRules)
    for (const bool closed : {false, true})
      for (const bool even : {false, true}) {
        const SplineRun run = randomRun(
            {.points = 5, .closed = closed, .tangents = {rule, 0.3f, -0.4f, 0.5f}, .constantSpeed = even}, 64,
            ++seed);
        for (uint32_t n = 0; n < run.splines; ++n) {
          Spline spline(chainOf(run, n));
          spline.clock = run.clocks[n];
          const reference::HermiteSpline expected(recipeOf(run, n));
          const reference::Travel travel = reference::travelAt(
              expected, {spline.clock.start, spline.clock.duration, spline.clock.active}, run.now, even);
          const SplineMotion motion = spline.at(run.now, even);
          // Both in double; the result is rounded to float32. A length is sought to 1e-12 of a segment.
          EXPECT_LT(glm::distance(glm::dvec3(motion.position), travel.position), 2e-6)
              << "seed " << run.seed << ", spline " << n;
          EXPECT_LT(glm::distance(glm::dvec3(motion.velocity), travel.velocity),
                    1e-6 * (1 + glm::length(travel.velocity)))
              << "seed " << run.seed << ", spline " << n;
          EXPECT_NEAR(motion.travelled, travel.travelled, 1e-6 * (1 + travel.travelled));
          EXPECT_EQ(static_cast<int>(motion.state), static_cast<int>(travel.state));
        }
      }
}

TEST(Spline, ConstantSpeedIsConstant) {
  Spline spline(cubicChain());
  spline.clock.duration = 2;
  spline.clock.activate(0);
  for (double now = 0; now < 2; now += 0.05) {
    EXPECT_NEAR(glm::length(spline.at(now, true).velocity), spline.length() / 2, 1e-6);
    EXPECT_NEAR(spline.lengthAt(spline.timeAtLength(now / 2 * spline.length())), now / 2 * spline.length(),
                1e-11);
  }
}

TEST(Spline, TravelsActivatedRescaledAndReset) {
  Spline spline(cubicChain());
  EXPECT_EQ(spline.clock.duration, 3);
  EXPECT_EQ(spline.at(100).state, SplineState::idle);
  EXPECT_EQ(spline.at(100).position, cubic(-1));
  spline.clock.activate(100);
  EXPECT_EQ(spline.at(99).state, SplineState::idle);
  EXPECT_EQ(spline.at(99).velocity, vec3(0));
  EXPECT_EQ(spline.at(101.5).position, cubic(0.5f));
  EXPECT_EQ(spline.at(101.5).velocity, cubicVelocity(0.5f));
  EXPECT_DOUBLE_EQ(spline.progress(101.5), 0.5);
  // Half the way is left; at half the speed it takes 3 s.
  spline.clock.rescale(6, 101.5);
  EXPECT_EQ(spline.at(101.5).position, cubic(0.5f));
  EXPECT_EQ(spline.at(101.5).velocity, 0.5f * cubicVelocity(0.5f));
  EXPECT_FALSE(spline.finished(104.4));
  EXPECT_TRUE(spline.finished(104.5));
  EXPECT_EQ(spline.at(200).position, cubic(2));
  EXPECT_EQ(spline.at(200).velocity, vec3(0));
  EXPECT_NEAR(spline.at(200).travelled, spline.length(), 1e-6);
  // Finished stays finished, and a clock that has not begun begins when it would have.
  spline.clock.rescale(60, 200);
  EXPECT_TRUE(spline.finished(200));
  spline.clock.activate(300);
  spline.clock.rescale(2, 250);
  EXPECT_EQ(spline.clock.start, 300);
  spline.clock.reset();
  EXPECT_EQ(spline.at(301).position, cubic(-1));
  EXPECT_EQ(spline.at(301).travelled, 0);
}

TEST(Spline, AClosedOneGoesRoundAndRound) {
  Spline spline({.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, .closed = true});
  spline.clock.activate(0);
  EXPECT_FALSE(spline.finished(1000));
  EXPECT_LT(glm::distance(spline.at(301.25).position, spline.at(1.25).position), 1e-6f);
  EXPECT_NEAR(spline.at(301.25).travelled, 100 * spline.length() + spline.at(1.25).travelled, 1e-4);
  EXPECT_EQ(spline.clock.rounds(301.25, true), 100);
}

TEST(Spline, KnotsFromChords) {
  const std::vector<vec3> points = {{0, 0, 0}, {4, 0, 0}, {4, 9, 0}};
  EXPECT_EQ(splineKnots(points, false, 0), (std::vector<float>{0, 1, 2}));
  EXPECT_EQ(splineKnots(points, false, 0.5f), (std::vector<float>{0, 2, 5}));
  EXPECT_EQ(splineKnots(points, false, 1), (std::vector<float>{0, 4, 13}));
  EXPECT_EQ(splineKnots(points, true, 0), (std::vector<float>{0, 1, 2, 3}));
  // Points on one another still are apart in time, late ones too.
  std::vector<vec3> still(5, vec3(1000, 0, 0));
  still[0] = vec3(0);
  EXPECT_NO_THROW(Spline({.points = still, .knots = splineKnots(still, false, 1)}));
  EXPECT_NO_THROW(
      Spline({.points = std::vector<vec3>(9), .knots = splineKnots(std::vector<vec3>(9), false, 1)}));
}

}  // namespace
}  // namespace skitter::test

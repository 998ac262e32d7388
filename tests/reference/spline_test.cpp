#include "cpu_reference/spline/spline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

// The reference of splines against closed forms.
namespace skitter::test {
namespace {

using namespace reference;
using glm::dvec3;

dvec3 cubic(double t) { return {1 + t - 2 * t * t + t * t * t, 3 - t * t * t, 0.5 * t * t}; }
dvec3 cubicVelocity(double t) { return {1 - 4 * t + 3 * t * t, -3 * t * t, t}; }
dvec3 cubicAcceleration(double t) { return {-4 + 6 * t, -6 * t, 1}; }
dvec3 parabola(double t) { return {t, t * t, 0}; }

const std::vector<double> unevenKnots = {-1.3, -0.4, 0.1, 0.15, 2.0, 2.7};

SplineRecipe sampled(const std::function<dvec3(double)>& point, TangentRule rule) {
  SplineRecipe recipe{.rule = rule};
  for (const double t : unevenKnots) recipe.keys.push_back({t, point(t)});
  return recipe;
}

TEST(ReferenceSpline, ACubicIsKeptWithItsDerivatives) {
  SplineRecipe recipe = sampled(cubic, TangentRule::given);
  for (SplineKey& key : recipe.keys) key.arriving = key.leaving = cubicVelocity(key.time);
  const HermiteSpline spline(recipe);
  for (double t = -1.3; t < 2.7; t += 0.01) {
    const SplineSample sample = spline.at(t);
    EXPECT_LT(glm::distance(sample.position, cubic(t)), 1e-13);
    EXPECT_LT(glm::distance(sample.velocity, cubicVelocity(t)), 1e-11);
    EXPECT_LT(glm::distance(sample.acceleration, cubicAcceleration(t)), 1e-9);
  }
}

TEST(ReferenceSpline, CatmullRomKeepsQuadraticMotion) {
  const HermiteSpline spline(sampled(parabola, TangentRule::catmullRom));
  for (double t = -1.3; t < 2.7; t += 0.01) {
    EXPECT_LT(glm::distance(spline.at(t).position, parabola(t)), 1e-13);
    EXPECT_LT(glm::distance(spline.at(t).velocity, dvec3(1, 2 * t, 0)), 1e-11);
  }
}

TEST(ReferenceSpline, EveryRuleButZeroAndTensionKeepsEvenMotion) {
  const auto line = [](double t) { return dvec3(1, 2, 3) + t * dvec3(2, -1, 0.5); };
  for (const TangentRule rule :
       {TangentRule::catmullRom, TangentRule::finiteDifference, TangentRule::cardinal,
        TangentRule::kochanekBartels, TangentRule::monotone}) {
    const HermiteSpline spline(sampled(line, rule));
    for (double t = -1.3; t < 2.7; t += 0.05)
      EXPECT_LT(glm::distance(spline.at(t).velocity, dvec3(2, -1, 0.5)), 1e-12) << int(rule);
    EXPECT_NEAR(spline.length(), 4 * std::sqrt(5.25), 1e-13);
  }
}

TEST(ReferenceSpline, TangentsOfThreePointsByHand) {
  SplineRecipe recipe{.keys = {{0, {0, 0, 0}}, {1, {1, 0, 0}}, {3, {1, 4, 0}}}};
  const auto middle = [&](TangentRule rule) {
    recipe.rule = rule;
    return HermiteSpline(recipe).keys()[1];
  };
  const auto expect = [](const dvec3& found, const dvec3& wanted) {
    EXPECT_LT(glm::distance(found, wanted), 1e-15) << found.x << " " << found.y;
  };
  // Slopes (1, 0) for 1 and (0, 2) for 2.
  expect(middle(TangentRule::catmullRom).leaving, {2.0 / 3, 2.0 / 3, 0});
  expect(middle(TangentRule::finiteDifference).leaving, {0.5, 1, 0});
  recipe.tension = 0.25;
  expect(middle(TangentRule::cardinal).leaving, {0.25, 1, 0});
  recipe.continuity = 0.5, recipe.bias = -0.5;
  // 0.375 (1 - C)(1 + B) = 0.09375, 0.375 (1 + C)(1 - B) = 0.84375; leaving 0.375 * 0.75 both.
  expect(middle(TangentRule::kochanekBartels).arriving, {0.09375, 1.6875, 0});
  expect(middle(TangentRule::kochanekBartels).leaving, {0.28125, 0.5625, 0});
  expect(middle(TangentRule::monotone).leaving, {0, 0, 0});
  expect(middle(TangentRule::zero).leaving, {0, 0, 0});
}

TEST(ReferenceSpline, MonotoneNeverOvershoots) {
  SplineRecipe recipe{.rule = TangentRule::monotone};
  const double heights[] = {0, 0.01, 5, 5.001, 5.001, 40, 41};
  for (int k = 0; k < 7; ++k) recipe.keys.push_back({k + 0.3 * (k % 2), {heights[k], -heights[k], 0}});
  const HermiteSpline spline(recipe);
  for (double t = 0; t < 6; t += 0.001) {
    EXPECT_GE(spline.at(t).velocity.x, -1e-12) << t;
    EXPECT_LE(spline.at(t).velocity.y, 1e-12) << t;
  }
  EXPECT_GT(spline.at(0.5).velocity.x, 0);
}

TEST(ReferenceSpline, ArcLengthOfAParabolaWithinTheStatedBound) {
  // y = x^2 from 0 to x: x sqrt(1 + 4 x^2) / 2 + asinh(2 x) / 4.
  const auto exact = [](double x) { return 0.5 * x * std::sqrt(1 + 4 * x * x) + 0.25 * std::asinh(2 * x); };
  for (const double from : {0.0, -1.0, -3.0, 0.5}) {
    for (const double to : {1.0, 2.0, 6.0}) {
      SplineRecipe recipe{.keys = {{from, parabola(from), {1, 2 * from, 0}, {1, 2 * from, 0}},
                                   {to, parabola(to), {1, 2 * to, 0}, {1, 2 * to, 0}}},
                          .rule = TangentRule::given};
      const HermiteSpline spline(recipe);
      const double truth = exact(to) - exact(from);
      EXPECT_LE(std::abs(spline.length() - truth), lengthErrorBound(spline.segment(0)));
      EXPECT_NEAR(trueLength(spline.segment(0), 1e-6), truth, 1e-6);
      // The speed sqrt(1 + 4 x^2) is zero at x = +-i/2; M on the ellipse is at most that at the far end of
      // its half-axes.
      double bound = 0;
      for (int half = 0; half < 2; ++half) {
        const double width = (to - from) / 4, middle = from + width * (1 + 2 * half);
        const std::complex<double> z = (std::complex<double>(0, 0.5) - middle) / width;
        const std::complex<double> root = std::sqrt(z * z - 1.0);
        const double rho = std::max(std::abs(z + root), std::abs(z - root));
        const double reach = std::abs(middle) + width * (rho + 1 / rho) / 2;
        bound +=
            width * 64 / 15 * std::sqrt(1 + 4 * reach * reach) * std::pow(rho, -16) / (1 - 1 / (rho * rho));
      }
      EXPECT_LE(std::abs(spline.length() - truth), bound + 1e-13) << from << " " << to;
    }
  }
}

TEST(ReferenceSpline, TheQuadratureStaysWithinTheBoundForCusps) {
  const Bezier cusp{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}},
      there{{0, 0, 0}, {2, 0, 0}, {-1, 0, 0}, {1, 0, 0}};
  for (const Bezier& curve : {cusp, there}) {
    const double off = std::abs(quadratureLength(curve, 1) - trueLength(curve, 1e-5));
    EXPECT_LE(off, lengthErrorBound(curve) + 1e-5);
    EXPECT_LE(off, 0.01 * trueLength(curve, 1e-5));
  }
}

TEST(ReferenceSpline, ACircleIsMetAsFarAsFourSegmentsCan) {
  // The tangent that puts a quarter's middle on the circle: 4 (sqrt(2) - 1) r over a quarter's s; the radius
  // is then off by at most 2.73e-4 of it, outward.
  const double m = 4 * (std::numbers::sqrt2 - 1);
  SplineRecipe recipe{.closed = true, .rule = TangentRule::given};
  for (int k = 0; k <= 4; ++k) {
    const double angle = k * std::numbers::pi / 2;
    const dvec3 point(std::cos(angle), std::sin(angle), 0), tangent(-point.y * m, point.x * m, 0);
    recipe.keys.push_back({double(k), point, tangent, tangent});
  }
  const HermiteSpline spline(recipe);
  double worst = 0;
  for (double t = 0; t < 4; t += 0.001)
    worst = std::max(worst, std::abs(glm::length(spline.at(t).position) - 1));
  EXPECT_NEAR(worst, 2.73e-4, 1e-6);
  EXPECT_NEAR(spline.length(), 2 * std::numbers::pi, 2 * std::numbers::pi * 2.73e-4);
  EXPECT_LT(glm::distance(spline.at(-1).position, dvec3(0, -1, 0)), 1e-15);
  EXPECT_LT(glm::distance(spline.at(9).position, dvec3(0, 1, 0)), 1e-15);
}

TEST(ReferenceSpline, TimeAtALengthIsItsInverse) {
  const HermiteSpline spline(sampled(cubic, TangentRule::catmullRom));
  for (int k = 0; k <= 50; ++k) {
    const double length = spline.length() * k / 50;
    EXPECT_NEAR(spline.lengthAt(spline.timeAtLength(length)), length, 1e-12);
  }
}

TEST(ReferenceSpline, RescalingKeepsThePlace) {
  const HermiteSpline spline(sampled(cubic, TangentRule::catmullRom));
  const TravelClock clock{10, 4, true};
  const Travel before = travelAt(spline, clock, 11, false);
  const Travel after = travelAt(spline, rescaled(clock, 8, 11), 11, false);
  EXPECT_LT(glm::distance(before.position, after.position), 1e-14);
  EXPECT_LT(glm::distance(before.velocity, 2.0 * after.velocity), 1e-13);
  EXPECT_EQ(travelAt(spline, rescaled(clock, 8, 11), 16.9, false).state, TravelState::moving);
  EXPECT_EQ(travelAt(spline, rescaled(clock, 8, 11), 17, false).state, TravelState::finished);
}

}  // namespace
}  // namespace skitter::test

#include "assets/models/clip_sampler.h"

#include <gtest/gtest.h>

#include <cmath>

// Sampling held against closed forms (docs/clip.md).
namespace skitter {
namespace {

using gltf::Interpolation;
using gltf::Path;
using gltf::Sampler;

constexpr double pi = 3.14159265358979323846;

Sampler vectors(Interpolation interpolation, std::vector<double> times, const std::vector<double>& x) {
  Sampler sampler{Path::translation, interpolation, std::move(times), {}};
  for (const double value : x) sampler.values.insert(sampler.values.end(), {value, 2 * value, -value});
  return sampler;
}

// Turns about +Y.
Sampler turns(Interpolation interpolation, std::vector<double> times, const std::vector<double>& angles) {
  Sampler sampler{Path::rotation, interpolation, std::move(times), {}};
  for (const double angle : angles) {
    sampler.values.insert(sampler.values.end(), {0, std::sin(angle / 2), 0, std::cos(angle / 2)});
  }
  return sampler;
}

double angleOf(const glm::dquat& q) { return 2 * std::atan2(q.y, q.w); }

TEST(ClipSampler, StepHoldsAndJumpsAtItsKey) {
  const Sampler step = vectors(Interpolation::step, {1, 2, 4}, {5, 7, 9});
  EXPECT_EQ(sampleVector(step, 0).x, 5);
  EXPECT_EQ(sampleVector(step, 1.999).x, 5);
  EXPECT_EQ(sampleVector(step, 2, Side::before).x, 5);
  EXPECT_EQ(sampleVector(step, 2).x, 7);
  EXPECT_EQ(sampleVector(step, 4, Side::before).x, 7);
  EXPECT_EQ(sampleVector(step, 4).x, 9);
  EXPECT_EQ(sampleVector(step, 400), glm::dvec3(9, 18, -9));
  EXPECT_EQ(sampleVector(step, 1, Side::before).x, 5);
}

TEST(ClipSampler, LinearIsStraightAndHoldsItsEnds) {
  const Sampler linear = vectors(Interpolation::linear, {1, 3}, {2, 6});
  for (const double t : {0.0, 1.0}) EXPECT_EQ(sampleVector(linear, t).x, 2);
  for (const double t : {3.0, 7.0}) EXPECT_EQ(sampleVector(linear, t).x, 6);
  for (double t = 1; t <= 3; t += 0.125) EXPECT_NEAR(sampleVector(linear, t).x, 2 * t, 1e-14);
  EXPECT_EQ(sampleVector(linear, 3, Side::before).x, 6);
}

TEST(ClipSampler, RotationsTurnEvenlyAlongTheShorterArc) {
  const Sampler even = turns(Interpolation::linear, {0, 2}, {0.2, 2.8});
  for (double t = 0; t <= 2; t += 0.125) EXPECT_NEAR(angleOf(sampleRotation(even, t)), 0.2 + 1.3 * t, 1e-12);
  // 350 degrees is 10 degrees the other way.
  const Sampler around = turns(Interpolation::linear, {0, 1}, {0, 350 * pi / 180});
  for (double t = 0; t <= 1; t += 0.125) {
    const glm::dquat q = sampleRotation(around, t);
    EXPECT_NEAR(std::remainder(angleOf(q) + t * 10 * pi / 180, 2 * pi), 0, 1e-12) << t;
  }
  // Keys that differ by less than the sine can tell.
  const Sampler close = turns(Interpolation::linear, {0, 1}, {1, 1 + 1e-9});
  EXPECT_NEAR(angleOf(sampleRotation(close, 0.5)), 1 + 5e-10, 1e-13);
  const Sampler step = turns(Interpolation::step, {0, 1}, {1, 2});
  EXPECT_NEAR(angleOf(sampleRotation(step, 0.9)), 1, 1e-12);
  EXPECT_NEAR(angleOf(sampleRotation(step, 1)), 2, 1e-12);
}

TEST(ClipSampler, CubicSplinesRepeatACubic) {
  // Any two keys of p(t) = t^3 - 2 t^2 + 3, with their slopes, give all of it.
  const auto p = [](double t) { return t * t * t - 2 * t * t + 3; };
  const auto slope = [](double t) { return 3 * t * t - 4 * t; };
  std::vector<double> values;
  const std::vector<double> times{0.5, 1.25, 3};
  for (const double t : times) values.insert(values.end(), {slope(t), p(t), slope(t)});
  const Sampler cubic = vectors(Interpolation::cubicSpline, times, values);
  for (double t = 0.5; t <= 3; t += 0.0625) {
    EXPECT_NEAR(sampleVector(cubic, t).x, p(t), 1e-12) << t;
    EXPECT_NEAR(sampleVector(cubic, t).y, 2 * p(t), 1e-12) << t;
  }
  EXPECT_EQ(sampleVector(cubic, 0).x, p(0.5));
  EXPECT_EQ(sampleVector(cubic, 9).x, p(3));
  // In- and out-tangents are told apart.
  const Sampler bent = vectors(Interpolation::cubicSpline, {0, 2}, {100, 0, 1, -1, 0, 100});
  EXPECT_NEAR(sampleVector(bent, 1).x, 2 * 0.125 * 1 + 2 * -0.125 * -1, 1e-14);
}

TEST(ClipSampler, CubicRotationsAreNormalised) {
  Sampler cubic = turns(Interpolation::cubicSpline, {0, 1}, {0, 0.3, 0, 0, 1.1, 0});
  for (const size_t tangent : {size_t{0}, size_t{2}, size_t{3}, size_t{5}}) {
    for (size_t k = 0; k < 4; ++k) cubic.values[4 * tangent + k] = 0;
  }
  // Without tangents the smooth step between the two.
  const double u = 0.3, w = 3 * u * u - 2 * u * u * u;
  const double s = (1 - w) * std::sin(0.15) + w * std::sin(0.55),
               c = (1 - w) * std::cos(0.15) + w * std::cos(0.55);
  const glm::dquat q = sampleRotation(cubic, u);
  EXPECT_NEAR(glm::length(q), 1, 1e-14);
  EXPECT_NEAR(angleOf(q), 2 * std::atan2(s, c), 1e-13);
  // Opposite keys meet in nothing: the first is held.
  for (size_t k = 0; k < 4; ++k) cubic.values[16 + k] = -cubic.values[4 + k];
  EXPECT_NEAR(angleOf(sampleRotation(cubic, 0.5)), 0.3, 1e-12);
}

TEST(ClipSampler, OneKeyIsHeld) {
  for (const Interpolation kind : {Interpolation::step, Interpolation::linear}) {
    for (const double t : {0.0, 1.0, 2.0}) EXPECT_EQ(sampleVector(vectors(kind, {1}, {4}), t).x, 4);
  }
  EXPECT_EQ(sampleVector(vectors(Interpolation::cubicSpline, {1}, {7, 4, 8}), 2).x, 4);
}

// A parent scaled along x and a child turned: the child's own child is sheared.
TEST(ClipSampler, HierarchiesAreProductsOfWholeMatrices) {
  gltf::Document document;
  document.nodes.resize(3);
  document.parentsFirst = {0, 1, 2};
  document.nodes[1].parent = 0;
  document.nodes[2].parent = 1;
  document.nodes[2].translation = {0, 0, 1};
  document.nodes[2].parentFromNode[3] = {0, 0, 1, 1};
  gltf::Clip clip;
  Sampler scale{Path::scale, Interpolation::linear, {0, 1}, {1, 1, 1, 3, 1, 1}};
  clip.samplers = {scale, turns(Interpolation::linear, {0, 1}, {0, pi / 2})};
  clip.moving = {{0, 0}, {1, 1}};
  ClipSampler sampler(document, clip, document.parentsFirst, glm::dmat4(1));
  // A quarter turn about y takes z to x, which is three times as long there; x to -z.
  const glm::dmat4& whole = sampler.sample(1)[2];
  EXPECT_LT(glm::length(glm::dvec3(whole[3]) - glm::dvec3(3, 0, 0)), 1e-12);
  // At 45 degrees what was square is sheared.
  const glm::dmat3 half(sampler.sample(0.5)[2]);
  const double r = std::sqrt(0.5);
  EXPECT_LT(glm::length(half[0] - glm::dvec3(2 * r, 0, -r)), 1e-12);
  EXPECT_LT(glm::length(half[2] - glm::dvec3(2 * r, 0, r)), 1e-12);
  EXPECT_EQ(sampler.keyTimes(), (std::vector<double>{0, 1}));
  EXPECT_TRUE(sampler.jumpTimes().empty());
}

}  // namespace
}  // namespace skitter

#include "skitter/spline.h"

#include <cmath>
#include <limits>
#include <utility>

#include "public/public.h"

namespace skitter::test {
namespace {

using glm::vec3;

const std::vector<vec3> wayPoints{{0, 0, 0}, {2, 0, 0}, {4, 0, 0}};  // straight on, 2 per knot

TEST(PublicSpline, RulesAndStatesHaveNames) {
  for (const SplineRule rule : allSplineRules) EXPECT_EQ(splineRuleNamed(nameOf(rule)), rule);
  EXPECT_EQ(splineRuleNamed("cubic"), std::nullopt);
  EXPECT_STREQ(nameOf(SplineState::finished), "finished");
}

TEST(PublicSpline, KnotsAreApartByAPowerOfTheDistance) {
  const std::vector<vec3> points{{0, 0, 0}, {4, 0, 0}, {4, 1, 0}};
  EXPECT_EQ(splineKnots(points, false, 1), (std::vector<float>{0, 4, 5}));
  EXPECT_EQ(splineKnots(points, false, 0.5f), (std::vector<float>{0, 2, 3}));
  EXPECT_EQ(splineKnots(points, true, 0), (std::vector<float>{0, 1, 2, 3}));
  expectRefused("1 points", [] { splineKnots(std::vector<vec3>(1), false, 1); });
  expectRefused("power of the chords is 2", [&] { splineKnots(points, false, 2); });
  expectRefused("point 0 is (inf", [] {
    splineKnots(std::vector<vec3>(2, vec3(std::numeric_limits<float>::infinity())), false, 1);
  });
}

// On a straight line with even knots everything is linear.
TEST(PublicSpline, GoesStraightThroughPointsOnALine) {
  const Spline spline(SplineChain{.points = wayPoints});
  EXPECT_EQ(spline.begin(), 0);
  EXPECT_EQ(spline.end(), 2);
  EXPECT_FALSE(spline.closed());
  EXPECT_NEAR(spline.length(), 4, 1e-9);
  for (const double time : {0.0, 0.3, 1.0, 1.7}) {
    EXPECT_LT(glm::distance(spline.position(time), vec3(2 * time, 0, 0)), 1e-6) << time;
    EXPECT_LT(glm::distance(spline.velocity(time), vec3(2, 0, 0)), 1e-6) << time;
    EXPECT_LT(glm::length(spline.acceleration(time)), 1e-6) << time;
    EXPECT_NEAR(spline.lengthAt(time), 2 * time, 1e-9) << time;
    EXPECT_NEAR(spline.timeAtLength(2 * time), time, 1e-9) << time;
  }
  EXPECT_EQ(spline.position(9), vec3(4, 0, 0));
}

TEST(PublicSpline, IsTravelledByItsClock) {
  Spline spline(SplineChain{.points = wayPoints});
  EXPECT_EQ(spline.at(1).state, SplineState::idle);
  spline.clock.activate(10);
  const SplineMotion half = spline.at(11);
  EXPECT_EQ(half.state, SplineState::moving);
  EXPECT_LT(glm::distance(half.position, vec3(2, 0, 0)), 1e-6);
  EXPECT_NEAR(half.travelled, 2, 1e-6);
  EXPECT_LT(glm::distance(spline.at(11, true).velocity, vec3(2, 0, 0)), 1e-6);
  EXPECT_EQ(spline.progress(11), 0.5);
  EXPECT_FALSE(spline.finished(11.5));
  EXPECT_TRUE(spline.finished(12));
}

TEST(PublicSpline, RefusesChainsThatCannotBe) {
  expectRefused("1 points, expected 2 to 1024", [] { Spline(SplineChain{.points = {vec3(0)}}); });
  expectRefused("2 knots, expected 3", [] { Spline(SplineChain{.points = wayPoints, .knots = {0, 1}}); });
  expectRefused("knot 2 is 1 after 1", [] { Spline(SplineChain{.points = wayPoints, .knots = {0, 1, 1}}); });
  expectRefused("0 arriving tangents",
                [] { Spline(SplineChain{.points = wayPoints, .tangents = {.rule = SplineRule::given}}); });
}

TEST(PublicSplineClock, KeepsItsPlaceWhenItIsRescaled) {
  SplineClock clock{.duration = 4};
  clock.activate(2);
  EXPECT_EQ(clock.progress(3, false), 0.25);
  clock.rescale(8, 3);
  EXPECT_EQ(clock.progress(3, false), 0.25);
  EXPECT_EQ(clock.progress(5, false), 0.5);
  EXPECT_EQ(clock.state(9, false), SplineState::finished);
  EXPECT_EQ(clock.state(9, true), SplineState::moving);
  EXPECT_EQ(clock.rounds(17.5, true), 2);
  EXPECT_EQ(clock.rounds(17.5, false), 0);
  clock.reset();
  EXPECT_EQ(clock.state(9, false), SplineState::idle);
  EXPECT_EQ(clock.duration, 8);
  expectRefused("duration is 0, expected more than 0", [&] { clock.rescale(0, 1); });
  EXPECT_EQ(clock.duration, 8);
}

class PublicSplineBatch : public PublicTest {
 protected:
  // Along x and along z, as above.
  static std::vector<vec3> points() {
    std::vector<vec3> all = wayPoints;
    for (const vec3& p : wayPoints) all.emplace_back(0, 0, p.x);
    return all;
  }
  static std::vector<SplineClock> clocks() {
    return {{.start = 0, .duration = 2, .active = true}, {.start = 0, .duration = 4, .active = true}};
  }
  static void expectAtOne(const std::vector<SplineMotion>& motions) {
    ASSERT_EQ(motions.size(), 2u);
    EXPECT_LT(glm::distance(motions[0].position, vec3(2, 0, 0)), 1e-4);
    EXPECT_LT(glm::distance(motions[1].position, vec3(0, 0, 1)), 1e-4);
    EXPECT_EQ(motions[1].state, SplineState::moving);
  }
};

TEST_F(PublicSplineBatch, TravelsAsOneSplineDoes) {
  SplineBatch first(device(), 2, {.points = 3});
  SplineBatch batch = std::move(first);
  EXPECT_EQ(batch.splines(), 2u);
  EXPECT_EQ(batch.points(), 3u);
  EXPECT_EQ(batch.keys(), 3u);
  EXPECT_GT(batch.memoryBytes(), 2u * 3 * 16);
  batch.setPoints(points());
  batch.setClocks(clocks());
  batch.travel(1);
  expectAtOne(batch.downloadMotions());
  const std::vector<float> lengths = batch.downloadLengths();
  ASSERT_EQ(lengths.size(), 2u);
  EXPECT_NEAR(lengths[0], 4, 1e-4);
  device().run([&](VkCommandBuffer commands) { batch.record(commands, 9); });
  EXPECT_EQ(batch.downloadMotions()[0].state, SplineState::finished);
}

TEST_F(PublicSplineBatch, TakesTangentsWhereItMakesNone) {
  SplineBatch batch(device(), 1, {.points = 2, .tangents = {.rule = SplineRule::given}});
  batch.setPoints(std::vector<vec3>{{0, 0, 0}, {1, 0, 0}});
  batch.setTangents(std::vector<vec3>{{1, 0, 0}, {1, 0, 0}});
  EXPECT_NEAR(batch.downloadLengths()[0], 1, 1e-5);
  EXPECT_NE(batch.tangents(0).buffer, VkBuffer{VK_NULL_HANDLE});
  SplineBatch ruled(device(), 1, {.points = 2});
  expectRefused("makes them by rule", [&] { ruled.setTangents(std::vector<vec3>(2)); });
}

TEST_F(PublicSplineBatch, WorksInTheCallersBuffers) {
  const OwnBuffer keys(device(), 2 * 3 * 16), motions(device(), 2 * 2 * 16);
  SplineBatch batch(device(), 2, {.points = 3});
  batch.setClocks(clocks());
  batch.use({.keys = {keys.handle(), keys.bytes()}, .motions = {motions.handle(), motions.bytes()}});
  for (size_t i = 0; i < 6; ++i) {
    const vec3 point = points()[i];
    const float key[] = {point.x, point.y, point.z, static_cast<float>(i % 3)};
    std::copy_n(key, 4, keys.floats() + 4 * i);
  }
  device().run([&](VkCommandBuffer commands) {
    batch.recordPrepare(commands);
    batch.record(commands, 1);
    OwnBuffer::toHost(commands);
  });
  expectAtOne(batch.downloadMotions());
  EXPECT_NEAR(motions.floats()[0], 2, 1e-4);  // x of the first position
  expectRefused("the buffer for motions has 16 bytes, 2 splines need 64", [&] {
    batch.use({.motions = {motions.handle(), 16}});
  });
}

TEST_F(PublicSplineBatch, IsSplitOverPages) {
  SplineBatch batch(device(), 5, {.points = 3, .pageSplines = 2});
  EXPECT_EQ(batch.pageSplines(), 2u);
  EXPECT_EQ(batch.pages(), 3u);
  EXPECT_GE(batch.keys(0).bytes, 2u * 3 * 16);
  EXPECT_NE(batch.clocks(2).buffer, batch.clocks(0).buffer);
  EXPECT_NE(batch.motions(2).buffer, VkBuffer{VK_NULL_HANDLE});
  expectRefused("page 3 of a batch, expected one of its 3", [&] { batch.keys(3); });
  expectRefused("page 3 of a batch", [&] { batch.tangents(3); });
  expectRefused("page 3 of a batch", [&] { batch.clocks(3); });
  expectRefused("page 4294967295 of a batch", [&] { batch.motions(UINT32_MAX); });
  expectRefused("5 splines take 3 pages", [&] { batch.use({}); });
}

TEST_F(PublicSplineBatch, RefusesWhatCannotBe) {
  expectRefused("a spline of 1 points", [&] { SplineBatch(device(), 1, {.points = 1}); });
  SplineBatch batch(device(), 2, {.points = 3});
  expectRefused("3 points, expected 6", [&] { batch.setPoints(wayPoints); });
  expectRefused("5 knots, expected 3", [&] { batch.setPoints(points(), std::vector<float>(5)); });
  expectRefused("1 clocks, expected 2", [&] { batch.setClocks(std::vector<SplineClock>(1)); });
  expectRefused("spline 1: its duration is 0", [&] {
    batch.setClocks(std::vector<SplineClock>{{.duration = 1}, {.duration = 0}});
  });
}

}  // namespace
}  // namespace skitter::test

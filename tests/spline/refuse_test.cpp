// What may not be a spline: refused by name on the host, marked on the device.
#include <cmath>
#include <limits>

#include "gpu/buffer.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "skitter/error.h"
#include "spline/runs.h"
#include "support/gpu_fixture.h"

namespace skitter::test {
namespace {

using glm::vec3;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
const std::vector<vec3> three = {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}};

template <class Call>
void expectRefused(const char* fault, const Call& call) {
  try {
    call();
    ADD_FAILURE() << "not refused: " << fault;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    EXPECT_NE(std::string(error.what()).find(fault), std::string::npos) << error.what();
  }
}

void expectRefused(const char* fault, const SplineChain& chain) {
  expectRefused(fault, [&] { (void)Spline(chain); });
}

TEST(SplineChain, ThatCannotBeIsRefused) {
  expectRefused("1 points, expected 2 to 1024", {.points = {vec3(0)}});
  expectRefused("1025 points", {.points = std::vector<vec3>(1025)});
  expectRefused("point 1 is (1, nan, 0)", {.points = {vec3(0), {1, nan, 0}}});
  expectRefused("point 0 is (2000000", {.points = {{2e6f, 0, 0}, vec3(0)}});
  expectRefused("2 knots, expected 3", {.points = three, .knots = {0, 1}});
  expectRefused("3 knots, expected 4", {.points = three, .knots = {0, 1, 2}, .closed = true});
  expectRefused("knot 2 is 1 after 1", {.points = three, .knots = {0, 1, 1}});
  expectRefused("knot 1 is -1 after 0", {.points = three, .knots = {0, -1, 1}});
  expectRefused("knot 1 is nan", {.points = three, .knots = {0, nan, 1}});
  expectRefused("tension is 1.5, expected 0 to 1",
                {.points = three, .tangents = {SplineRule::cardinal, 1.5f}});
  expectRefused("bias is nan, expected -1 to 1",
                {.points = three, .tangents = {SplineRule::kochanekBartels, 0, 0, nan}});
  expectRefused("0 arriving tangents, expected 3", {.points = three, .tangents = {SplineRule::given}});
  expectRefused(
      "tangent of point 2",
      {.points = three, .tangents = {SplineRule::given}, .arriving = {vec3(0), vec3(0), vec3(nan)}});
  expectRefused("1 leaving tangents",
                {.points = three, .tangents = {SplineRule::given}, .arriving = three, .leaving = {vec3(0)}});
  expectRefused("power of the chords is 2", [] { splineKnots(three, false, 2); });
}

TEST(SplineClock, ADurationThatCannotBeIsRefused) {
  SplineClock clock;
  expectRefused("duration is 0, expected more than 0", [&] { clock.rescale(0, 1); });
  expectRefused("duration is nan", [&] { clock.rescale(NAN, 1); });
  EXPECT_EQ(clock.duration, 1);
}

using SplineRefuseTest = GpuTest;

TEST_F(SplineRefuseTest, WhatTheHostGivesTheBatch) {
  expectRefused("a spline of 1 points", [&] { SplineBatch(device(), 1, {.points = 1}); });
  expectRefused("tension is 7", [&] { SplineBatch(device(), 1, {.tangents = {SplineRule::cardinal, 7}}); });
  SplineRun run = randomRun({.points = 3}, 4, 1);
  SplineBatch batch = batchOf(device(), run);
  batch.travel(run.now);
  const vec3 before = batch.downloadMotions()[2].position;
  SplineRun bad = run;
  bad.points[7].x = nan;
  expectRefused("spline 2: point 1", [&] { batch.setPoints(bad.points, bad.knots); });
  bad = run;
  bad.knots[10] = bad.knots[9];
  expectRefused("spline 3: knot 1", [&] { batch.setPoints(bad.points, bad.knots); });
  expectRefused("3 points, expected 12", [&] { batch.setPoints(three); });
  expectRefused("5 knots, expected 3", [&] { batch.setPoints(run.points, std::vector<float>(5)); });
  expectRefused("makes them by rule", [&] { batch.setTangents(run.arriving); });
  bad.clocks[1].duration = 0;
  expectRefused("spline 1: its duration is 0", [&] { batch.setClocks(bad.clocks); });
  bad.clocks[1] = {.start = NAN};
  expectRefused("spline 1: its clock starts at nan", [&] { batch.setClocks(bad.clocks); });
  // Nothing of it has changed the batch.
  batch.travel(run.now);
  EXPECT_EQ(batch.downloadMotions()[2].position, before);
  const gpu::Buffer small(context(), 16, "small");
  expectRefused("the buffer for motions has 16 bytes, 4 splines need 128", [&] {
    batch.use({.motions = {small.handle(), 16}});
  });
}

TEST_F(SplineRefuseTest, WhatIsWrongOnTheDeviceIsMarkedAndHurtsNoOther) {
  const SplineRun run = randomRun({.points = 3}, 65, 2);
  SplineBatch batch = batchOf(device(), run);
  batch.travel(run.now);
  const std::vector<SplineMotion> before = batch.downloadMotions();
  const SplineBatch::Span span = batch.keys(0), clockSpan = batch.clocks(0);
  const gpu::Buffer keys = gpu::Buffer::borrowed(context(), span.buffer, span.bytes, "keys"),
                    clocks = gpu::Buffer::borrowed(context(), clockSpan.buffer, clockSpan.bytes, "clocks");
  std::vector<glm::vec4> records = gpu::download<glm::vec4>(context(), keys),
                         times = gpu::download<glm::vec4>(context(), clocks);
  records[3 * 7 + 1].y = nan;
  records[3 * 20 + 2].w = records[3 * 20 + 1].w;
  records[3 * 30].w = nan;
  records[3 * 50].z = 2e6f;
  records[3 * 64 + 2].x = std::numeric_limits<float>::infinity();
  times[40].z = 0;
  times[41].x = nan;
  times[42].x = 2e30f;
  gpu::upload(context(), keys, records);
  gpu::upload(context(), clocks, times);
  gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
    batch.recordPrepare(cmd);
    batch.record(cmd, run.now);
  });
  const std::vector<SplineMotion> after = batch.downloadMotions();
  for (uint32_t n = 0; n < run.splines; ++n) {
    const bool wrong = n == 7 || n == 20 || n == 30 || (n >= 40 && n <= 42) || n == 50 || n == 64;
    EXPECT_EQ(after[n].state, wrong ? SplineState::refused : before[n].state) << n;
    EXPECT_EQ(after[n].position, wrong ? vec3(0) : before[n].position) << n;
    EXPECT_EQ(after[n].velocity, wrong ? vec3(0) : before[n].velocity) << n;
  }
}

// Tangents that the device is given may be wrong on one side alone.
TEST_F(SplineRefuseTest, ATangentThatCannotBeIsMarkedOnEitherSide) {
  SplineBatch batch(device(), 4, {.points = 3, .tangents = {SplineRule::given}});
  std::vector<vec3> points;
  for (int spline = 0; spline < 4; ++spline) points.insert(points.end(), three.begin(), three.end());
  batch.setPoints(points);
  batch.setTangents(std::vector<vec3>(12, vec3(1)));
  const SplineBatch::Span span = batch.tangents(0);
  const gpu::Buffer tangents = gpu::Buffer::borrowed(context(), span.buffer, span.bytes, "tangents");
  std::vector<glm::vec4> records = gpu::download<glm::vec4>(context(), tangents);
  records[2 * (3 * 1 + 1)].y = nan;        // arriving at a point of spline 1
  records[2 * (3 * 2 + 1) + 1].x = 2e12f;  // leaving one of spline 2
  gpu::upload(context(), tangents, records);
  gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
    batch.recordPrepare(cmd);
    batch.record(cmd, 0.5f);
  });
  const std::vector<SplineMotion> motions = batch.downloadMotions();
  for (size_t n = 0; n < 4; ++n) EXPECT_EQ(motions[n].state == SplineState::refused, n == 1 || n == 2) << n;
}

// Out and back by the largest tangents over the longest time.
TEST_F(SplineRefuseTest, ALengthThatFloat32CannotSumIsMarked) {
  SplineBatch batch(device(), 1, {.tangents = {SplineRule::given}});
  batch.setPoints(std::vector<vec3>(2), std::vector<float>{-1e6f, 1e6f});
  batch.setTangents(std::vector<vec3>{vec3(1e12f), vec3(-1e12f)});
  batch.travel(0);
  EXPECT_EQ(batch.downloadMotions()[0].state, SplineState::refused);
  EXPECT_EQ(batch.downloadLengths()[0], 0);
  batch.setTangents(std::vector<vec3>{vec3(1e11f), vec3(-1e11f)});
  batch.travel(0);
  EXPECT_EQ(batch.downloadMotions()[0].state, SplineState::idle);
  EXPECT_NEAR(batch.downloadLengths()[0], std::sqrt(3.0) * 1e17, 1e12);
}

}  // namespace
}  // namespace skitter::test

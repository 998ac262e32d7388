// Batches of splines on the device, held against the reference.
#include <fmt/format.h>

#include <cmath>
#include <random>

#include "cpu_reference/spline/tolerance.h"
#include "gpu/buffer.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "spline/runs.h"
#include "support/gpu_fixture.h"
#include "support/rounding.h"

namespace skitter::test {
namespace {

class SplineBatchTest : public GpuLoadTest {
 protected:
  void expectMatches(const SplineRun& run) {
    const Verdict verdict = judge(run, travelled(device(), run));
    EXPECT_LE(verdict.worst, 1) << verdict.text;
    if (verdict.worst > worst_.worst) worst_ = verdict;
  }
  void TearDown() override {
    if (worst_.worst > 0) fmt::print("{:.3f} of what is allowed: {}\n", worst_.worst, worst_.text);
    GpuLoadTest::TearDown();
  }

 private:
  Verdict worst_;
};
INSTANTIATE_TEST_SUITE_P(, SplineBatchTest, bothLoadPaths(), loadPathName);

SplineTangents someTangents(SplineRule rule) {
  return {.rule = rule, .tension = 0.3f, .continuity = -0.4f, .bias = 0.5f};
}

bool same(const SplineMotion& a, const SplineMotion& b) {
  return a.position == b.position && a.velocity == b.velocity && a.travelled == b.travelled &&
         a.state == b.state;
}

void expectSame(const std::vector<SplineMotion>& a, const std::vector<SplineMotion>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t n = 0; n < a.size(); ++n) ASSERT_TRUE(same(a[n], b[n])) << n;
}

TEST_P(SplineBatchTest, EveryRuleOpenAndClosed) {
  uint64_t seed = 100;
  for (const SplineRule rule : allSplineRules)
    for (const bool closed : {false, true})
      for (const uint32_t points : {2u, 3u, 7u})
        expectMatches(
            randomRun({.points = points, .closed = closed, .tangents = someTangents(rule)}, 256, ++seed));
}

TEST_P(SplineBatchTest, AtConstantSpeed) {
  uint64_t seed = 200;
  for (const SplineRule rule : allSplineRules)
    for (const bool closed : {false, true})
      expectMatches(
          randomRun({.points = 5, .closed = closed, .tangents = someTangents(rule), .constantSpeed = true},
                    256, ++seed));
}

TEST_P(SplineBatchTest, EverySize) {
  for (const uint32_t splines : {0u, 1u, 63u, 64u, 65u, 100003u})
    expectMatches(randomRun({.points = 4}, splines, 300 + splines));
}

TEST_P(SplineBatchTest, MostPoints) { expectMatches(randomRun({.points = 1024, .closed = true}, 65, 400)); }

TEST_P(SplineBatchTest, PagesChangeNoBit) {
  SplineRun run = randomRun({.points = 4, .closed = true}, 200, 500);
  const std::vector<SplineMotion> whole = travelled(device(), run);
  run.options.pageSplines = 63;
  EXPECT_EQ(batchOf(device(), run).pages(), 4u);
  expectSame(whole, travelled(device(), run));
}

TEST_P(SplineBatchTest, WithoutArcLengthTheRestIsTheSame) {
  SplineRun run = randomRun({.points = 4}, 65, 600);
  const std::vector<SplineMotion> with = travelled(device(), run);
  run.options.arcLength = false;
  const std::vector<SplineMotion> without = travelled(device(), run);
  for (size_t n = 0; n < with.size(); ++n) {
    EXPECT_EQ(without[n].travelled, 0);
    if (!kernelsRoundAlike(device())) continue;
    EXPECT_EQ(with[n].position, without[n].position);
    EXPECT_EQ(with[n].velocity, without[n].velocity);
  }
}

// A closed spline's round takes as long at noon as it did at dawn: the place does not depend on how long ago
// the start was.
TEST_P(SplineBatchTest, TenThousandRoundsCostNoPrecision) {
  SplineRun run = randomRun({.points = 5, .closed = true}, 65, 700);
  for (SplineClock& clock : run.clocks) clock.activate(run.now - 10000.37 * float(clock.duration));
  expectMatches(run);
}

// Where a round ends rounding decides which one it is, but not how far one has come.
TEST_P(SplineBatchTest, RoundsAreCountedAtTheirTurn) {
  SplineRun run = randomRun({.points = 5, .closed = true}, 1024, 750);
  std::mt19937_64 random(751);
  for (SplineClock& clock : run.clocks) {
    const double rounds = double(random() % 10000 + 1), off = std::ldexp(1.0, -int(random() % 40));
    clock.activate(run.now - clock.duration * (rounds + (random() % 2 ? off : -off)));
  }
  expectMatches(run);
}

TEST_P(SplineBatchTest, RescalingUnderWayKeepsThePlace) {
  SplineRun run = randomRun({.points = 5}, 65, 800);
  SplineBatch batch = batchOf(device(), run);
  batch.travel(run.now);
  const std::vector<SplineMotion> before = batch.downloadMotions();
  for (SplineClock& clock : run.clocks) clock.rescale(float(2 * clock.duration), run.now);
  batch.setClocks(run.clocks);
  batch.travel(run.now);
  const std::vector<SplineMotion> after = batch.downloadMotions();
  for (uint32_t n = 0; n < run.splines; ++n) {
    EXPECT_EQ(after[n].state, before[n].state);
    EXPECT_LT(glm::distance(after[n].position, before[n].position), 2e-5f) << n;
    EXPECT_LT(glm::distance(2.0f * after[n].velocity, before[n].velocity), 5e-4f) << n;
  }
}

TEST_P(SplineBatchTest, LengthsAreTheReferences) {
  const SplineRun run = randomRun({.points = 6, .closed = true}, 65, 900);
  const std::vector<float> lengths = batchOf(device(), run).downloadLengths();
  for (uint32_t n = 0; n < run.splines; ++n) {
    const reference::SplineRecipe recipe = recipeOf(run, n);
    const reference::HermiteSpline spline(recipe);
    EXPECT_NEAR(lengths[n], spline.length(), reference::tolerance::SplineBounds(recipe, spline).length())
        << "seed " << run.seed << ", spline " << n;
  }
}

// Points on one another, there and back, the largest that may be, the shortest steps.
TEST_P(SplineBatchTest, NastyChains) {
  using glm::vec3;
  const std::vector<std::vector<vec3>> chains = {
      std::vector<vec3>(4, vec3(1, 2, 3)),
      {vec3(0), vec3(1), vec3(1), vec3(2)},
      {vec3(0), vec3(1), vec3(0), vec3(1)},
      {vec3(-1e6f), vec3(1e6f), vec3(-1e6f, 1e6f, 0), vec3(0)},
      {vec3(0), vec3(1e-30f), vec3(1e-20f), vec3(1)},
  };
  const std::vector<std::vector<float>> knots = {
      {0, 1, 2, 3}, {0, 2e-6f, 1, 2}, {-1e6f, -1, 1, 1e6f}, {1, 1.5f, 1.5f + 2e-6f, 2}};
  for (const SplineRule rule : allSplineRules)
    for (const bool even : {false, true}) {
      SplineRun run{.options = {.points = 4, .tangents = someTangents(rule), .constantSpeed = even},
                    .now = 5};
      for (const auto& chain : chains)
        for (const auto& times : knots)
          for (const float phase : {0.0f, 0.3f, 0.999f, 1.0f}) {
            run.points.insert(run.points.end(), chain.begin(), chain.end());
            run.arriving.insert(run.arriving.end(), 4, vec3(0.5f, 0, -2));
            run.knots.insert(run.knots.end(), times.begin(), times.end());
            run.clocks.emplace_back().activate(run.now - phase);
            ++run.splines;
          }
      run.leaving = run.arriving;
      const std::vector<SplineMotion> motions = travelled(device(), run);
      for (uint32_t n = 0; n < run.splines; ++n) {
        const SplineMotion& m = motions[n];
        ASSERT_TRUE(std::isfinite(glm::length(m.position)) && !std::isnan(glm::length(m.velocity)) &&
                    std::isfinite(m.travelled))
            << nameOf(rule) << ", spline " << n;
        const double size = glm::distance(run.points[4 * n], run.points[4 * n + 1]);
        if (size == 0 && n < 16 && rule != SplineRule::given) {
          EXPECT_EQ(m.position, run.points[4 * n]) << nameOf(rule) << ", spline " << n;
          EXPECT_EQ(m.velocity, vec3(0));
          EXPECT_EQ(m.travelled, 0);
        }
      }
      const Verdict verdict = judge(run, motions);
      EXPECT_LE(verdict.worst, 1) << verdict.text;
    }
}

// In the caller's command buffer and buffers: one record beyond each end stays as it is.
TEST_P(SplineBatchTest, TheCallersBuffers) {
  const SplineRun run = randomRun({.points = 4, .tangents = {SplineRule::given}}, 65, 1000);
  SplineBatch batch = batchOf(device(), run);
  batch.travel(run.now);
  const std::vector<SplineMotion> expected = batch.downloadMotions();
  const auto copyOf = [&](SplineBatch::Span span, size_t records) {
    std::vector<glm::vec4> data(records);
    const gpu::Buffer theirs = gpu::Buffer::borrowed(context(), span.buffer, span.bytes, "theirs");
    gpu::downloadBytes(context(), theirs, std::as_writable_bytes(std::span(data)));
    gpu::Buffer own(context(), span.bytes, "own");
    gpu::upload(context(), own, data);
    return own;
  };
  const gpu::Buffer keys = copyOf(batch.keys(0), 65 * 4), tangents = copyOf(batch.tangents(0), 65 * 8),
                    clocks = copyOf(batch.clocks(0), 65);
  const gpu::Buffer motions(context(), (65 * 2 + 1) * 16, "own motions");
  gpu::upload(context(), motions, std::vector<glm::vec4>(65 * 2 + 1, glm::vec4(7)));
  SplineBatch other(device(), run.splines, run.options);
  const auto spanOf = [](const gpu::Buffer& buffer) {
    return SplineBatch::Span{buffer.handle(), buffer.size()};
  };
  other.use({spanOf(keys), spanOf(tangents), spanOf(clocks), spanOf(motions)});
  gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
    other.recordPrepare(cmd);
    other.record(cmd, run.now);
    other.record(cmd, run.now);
  });
  const std::vector<glm::vec4> found = gpu::download<glm::vec4>(context(), motions);
  for (size_t n = 0; n < expected.size(); ++n) {
    EXPECT_EQ(glm::vec3(found[2 * n]), expected[n].position) << n;
    EXPECT_EQ(glm::vec3(found[2 * n + 1]), expected[n].velocity) << n;
  }
  EXPECT_EQ(found.back(), glm::vec4(7));
  expectSame(other.downloadMotions(), expected);
}

using SplinePathsTest = GpuTest;

TEST_F(SplinePathsTest, BeginAsPointsAtZeroThatAreMetAtEvenTimes) {
  for (const bool closed : {false, true}) {
    const SplineBatch batch(device(), 3, {.points = 4, .closed = closed});
    const SplineBatch::Span span = batch.keys(0);
    std::vector<glm::vec4> keys(span.bytes / sizeof(glm::vec4));
    const gpu::Buffer theirs = gpu::Buffer::borrowed(context(), span.buffer, span.bytes, "theirs");
    gpu::downloadBytes(context(), theirs, std::as_writable_bytes(std::span(keys)));
    const uint32_t each = batch.keys();
    ASSERT_EQ(each, closed ? 5u : 4u);
    ASSERT_GE(keys.size(), size_t{3} * each);
    for (size_t n = 0; n < 3 * each; ++n) EXPECT_EQ(keys[n], glm::vec4(0, 0, 0, n % each)) << n;
  }
}

TEST_F(SplinePathsTest, RecordPathsAgreeToTheBit) {
  if (!hasTexelPath()) GTEST_SKIP() << "the device has one load path only";
  for (const DeviceRequest& request : everyRecordPath()) {
    Device other = Device::create(request);
    for (const SplineRule rule : allSplineRules) {
      const SplineRun run =
          randomRun({.points = 5, .closed = true, .tangents = someTangents(rule)}, 200, 1100);
      expectSame(travelled(device(), run), travelled(other, run));
    }
    failOnMessages(*other.validationLog());
  }
}

}  // namespace
}  // namespace skitter::test

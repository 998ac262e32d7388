#include "spline/runs.h"

#include <fmt/format.h>

#include "cpu_reference/spline/tolerance.h"

namespace skitter::test {
namespace {

using glm::vec3;

float uniform(std::mt19937_64& random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}

vec3 inCube(std::mt19937_64& random, float half) {
  return {uniform(random, -half, half), uniform(random, -half, half), uniform(random, -half, half)};
}

uint32_t keysOf(const SplineRun& run) { return run.options.points + (run.options.closed ? 1 : 0); }

reference::TravelClock clockOf(const SplineClock& clock) {
  // The device has a float's duration.
  return {clock.start, double(float(clock.duration)), clock.active};
}

struct Finding {
  const char* what;
  double error, allowed;
  double share() const {
    return error <= allowed ? error / std::max(allowed, 1e-300)
                            : std::max(error / std::max(allowed, 1e-300), 2.0);
  }
};

// NaN compares as wrong.
std::vector<Finding> compare(const SplineMotion& found, const reference::Travel& expected,
                             const reference::tolerance::TravelBounds& bounds, bool arcLength) {
  const auto apart = [](const vec3& a, const glm::dvec3& b) { return glm::distance(glm::dvec3(a), b); };
  return {{"position", apart(found.position, expected.position), bounds.position},
          {"velocity", apart(found.velocity, expected.velocity), bounds.velocity},
          {"length travelled", std::abs(double(found.travelled) - (arcLength ? expected.travelled : 0)),
           bounds.travelled}};
}

}  // namespace

SplineRun randomRun(const SplineBatch::Options& options, uint32_t splines, uint64_t seed) {
  SplineRun run{.seed = seed, .options = options, .splines = splines};
  std::mt19937_64 random(seed);
  run.now = 3600.1;
  for (uint32_t n = 0; n < splines; ++n) {
    const vec3 middle = inCube(random, 10);
    float knot = uniform(random, -3, 3);
    for (uint32_t k = 0; k < keysOf(run); ++k) {
      run.knots.push_back(knot);
      knot += uniform(random, 0.1f, 1.5f);
    }
    for (uint32_t k = 0; k < options.points; ++k) {
      run.points.push_back(middle + inCube(random, 2));
      run.arriving.push_back(inCube(random, 4));
      run.leaving.push_back(inCube(random, 4));
    }
    SplineClock clock{.duration = uniform(random, 0.3f, 5)};
    clock.activate(run.now - clock.duration * uniform(random, -0.2f, options.closed ? 4.0f : 1.2f));
    if (n % 16 == 5) clock.reset();
    run.clocks.push_back(clock);
  }
  return run;
}

reference::SplineRecipe recipeOf(const SplineRun& run, uint32_t spline) {
  const SplineTangents& tangents = run.options.tangents;
  reference::SplineRecipe recipe{.closed = run.options.closed,
                                 .rule = static_cast<reference::TangentRule>(tangents.rule),
                                 .tension = tangents.tension,
                                 .continuity = tangents.continuity,
                                 .bias = tangents.bias};
  for (uint32_t k = 0; k < keysOf(run); ++k) {
    const size_t from = size_t{spline} * run.options.points + k % run.options.points;
    recipe.keys.push_back({run.knots[size_t{spline} * keysOf(run) + k], run.points[from], run.arriving[from],
                           run.leaving[from]});
  }
  return recipe;
}

SplineChain chainOf(const SplineRun& run, uint32_t spline) {
  const auto part = [&](const auto& list, size_t each) {
    return std::vector(list.begin() + ptrdiff_t(spline * each),
                       list.begin() + ptrdiff_t((spline + 1) * each));
  };
  return {.points = part(run.points, run.options.points),
          .knots = part(run.knots, keysOf(run)),
          .closed = run.options.closed,
          .tangents = run.options.tangents,
          .arriving = part(run.arriving, run.options.points),
          .leaving = part(run.leaving, run.options.points)};
}

SplineBatch batchOf(Device& device, const SplineRun& run) {
  SplineBatch batch(device, run.splines, run.options);
  batch.setPoints(run.points, run.knots);
  if (run.options.tangents.rule == SplineRule::given) batch.setTangents(run.arriving, run.leaving);
  batch.setClocks(run.clocks);
  return batch;
}

std::vector<SplineMotion> travelled(Device& device, const SplineRun& run) {
  SplineBatch batch = batchOf(device, run);
  batch.travel(run.now);
  return batch.downloadMotions();
}

Verdict judge(const SplineRun& run, const std::vector<SplineMotion>& motions) {
  Verdict verdict;
  const bool even = run.options.constantSpeed;
  for (uint32_t n = 0; n < run.splines; ++n) {
    const reference::SplineRecipe recipe = recipeOf(run, n);
    const reference::HermiteSpline spline(recipe);
    const reference::tolerance::SplineBounds bounds(recipe, spline);
    const reference::TravelClock clock = clockOf(run.clocks[n]);
    reference::Travel expected = reference::travelAt(spline, clock, run.now, even);
    const SplineMotion& found = motions[n];
    // At the very end, either side.
    if (expected.state == reference::TravelState::moving && found.state == SplineState::finished &&
        1 - expected.phase < 4 * reference::tolerance::roundoff)
      expected = reference::travelAt(spline, clock, run.now + 1e-6 * clock.duration, even);
    std::vector<Finding> findings =
        compare(found, expected, bounds.of(expected, clock.duration, even), run.options.arcLength);
    findings.push_back({"state", std::abs(double(found.state) - double(expected.state)), 0});
    for (const Finding& finding : findings) {
      const double share = finding.share();
      if (share <= verdict.worst) continue;
      verdict.worst = share;
      verdict.text = fmt::format(
          "seed {}, {} splines, {} {} points{}, spline {} at phase {}: {} is off by {}, {} allowed", run.seed,
          run.splines, nameOf(run.options.tangents.rule), run.options.points,
          run.options.closed ? ", closed" : "", n, expected.phase, finding.what, finding.error,
          finding.allowed);
    }
  }
  return verdict;
}

}  // namespace skitter::test

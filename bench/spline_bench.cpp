// Splines travelled in a tick, on the device beside one core of scalar C++: `a_spline`, CPU time of all
// threads (on a software device; elsewhere see the wall clock's `real_time`). Results are held against the
// reference before they are timed.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>

#include "cpu_reference/spline/tolerance.h"
#include "skitter/error.h"
#include "skitter/spline.h"

namespace {

using namespace skitter;
using glm::vec3;

constexpr uint32_t kSplines = 65536, kPoints = 8;
constexpr double kNow = 3600.1;

enum class Kind { motion, arcLength, constantSpeed };
constexpr const char* kindNames[] = {"motion", "arc-length", "constant-speed"};

struct Work {
  std::vector<vec3> points;
  std::vector<float> knots;
  std::vector<SplineClock> clocks;

  Work() {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(-2, 2), step(0.2f, 1), phase(0, 1);
    for (uint32_t n = 0; n < kSplines; ++n) {
      float knot = 0;
      for (uint32_t k = 0; k < kPoints; ++k) {
        points.emplace_back(place(random), place(random), place(random));
        knots.push_back(knot);
        knot += step(random);
      }
      clocks.emplace_back().activate(kNow - phase(random));
    }
  }
};

const Work& work() {
  static const Work made;
  return made;
}

// The CPU's own splines: a flat array of cubics, as its strongest scalar form would have it.
struct Cubic {
  vec3 p, a, c, e;
  float begins, step, length, before;
  vec3 tangent(float s) const { return a + s * (2.0f * c + 3.0f * s * e); }
  float lengthTo(float s) const {
    constexpr float node[] = {0.18343464f, 0.52553241f, 0.79666648f, 0.96028986f},
                    weight[] = {0.36268378f, 0.31370665f, 0.22238103f, 0.10122854f};
    float sum = 0;
    for (const float middle : {0.25f * s, 0.75f * s})
      for (int i = 0; i < 4; ++i)
        sum += weight[i] * (glm::length(tangent(middle - 0.25f * s * node[i])) +
                            glm::length(tangent(middle + 0.25f * s * node[i])));
    return 0.25f * s * sum;
  }
  float at(float wanted) const {
    float s = std::min(wanted / std::max(length, 1e-30f), 1.0f), low = 0, high = 1;
    for (int k = 0; k < 24; ++k) {
      const float off = lengthTo(s) - wanted;
      if (!(std::abs(off) > 1e-6f * length)) break;
      (off < 0 ? low : high) = s;
      const float next = s - off / glm::length(tangent(s));
      s = next > low && next < high ? next : 0.5f * (low + high);
    }
    return s;
  }
};

std::vector<Cubic> cubicsOf(const Work& from) {
  std::vector<Cubic> cubics;
  for (uint32_t n = 0; n < kSplines; ++n) {
    const float* knots = &from.knots[n * kPoints];
    const Spline spline(
        {.points = {from.points.begin() + n * kPoints, from.points.begin() + (n + 1) * kPoints},
         .knots = {knots, knots + kPoints}});
    for (uint32_t i = 0; i + 1 < kPoints; ++i) {
      const float h = knots[i + 1] - knots[i];
      const vec3 p = spline.position(knots[i]), d = spline.position(knots[i + 1]) - p;
      // Tangents are continuous: the end's is that of the segment after, or of the spline's end.
      const vec3 a = h * spline.velocity(knots[i]), b = h * spline.velocity(knots[i + 1]);
      const auto before = static_cast<float>(spline.lengthAt(knots[i]));
      cubics.push_back({p, a, 3.0f * d - 2.0f * a - b, a + b - 2.0f * d, knots[i], h,
                        static_cast<float>(spline.lengthAt(knots[i + 1])) - before, before});
    }
  }
  return cubics;
}

void travelScalar(const std::vector<Cubic>& cubics, const std::vector<SplineClock>& clocks, Kind kind,
                  std::vector<SplineMotion>& motions) {
  constexpr uint32_t segments = kPoints - 1;
  for (uint32_t n = 0; n < kSplines; ++n) {
    const Cubic* own = &cubics[n * segments];
    const SplineClock& clock = clocks[n];
    const auto elapsed = static_cast<float>(kNow - clock.start);
    const auto duration = static_cast<float>(clock.duration);
    const float phase = std::min(std::max(elapsed / duration, 0.0f), 1.0f);
    const Cubic& last = own[segments - 1];
    const float span = last.begins + last.step - own[0].begins, whole = last.before + last.length;
    const bool even = kind == Kind::constantSpeed;
    const float at = even ? phase * whole : own[0].begins + phase * span;
    uint32_t i = 0;
    while (i + 1 < segments && (even ? own[i + 1].before : own[i + 1].begins) <= at) ++i;
    const Cubic& cubic = own[i];
    const float s = even ? cubic.at(at - cubic.before) : std::min((at - cubic.begins) / cubic.step, 1.0f);
    const vec3 tangent = cubic.tangent(s);
    SplineMotion& motion = motions[n];
    motion.state = phase < 1 ? SplineState::moving : SplineState::finished;
    motion.position = cubic.p + s * (cubic.a + s * (cubic.c + s * cubic.e));
    motion.velocity = tangent * (even ? whole / (duration * std::max(glm::length(tangent), 1e-20f))
                                      : span / (duration * cubic.step));
    motion.travelled = kind == Kind::motion ? 0 : even ? at : cubic.before + cubic.lengthTo(s);
  }
}

// Every 16th spline within the tolerances of the reference.
bool hold(benchmark::State& state, const std::vector<SplineMotion>& motions, Kind kind) {
  const Work& of = work();
  const bool even = kind == Kind::constantSpeed;
  double worst = 0;
  for (uint32_t n = 0; n < kSplines; n += 16) {
    reference::SplineRecipe recipe;
    for (uint32_t k = 0; k < kPoints; ++k)
      recipe.keys.push_back({of.knots[n * kPoints + k], of.points[n * kPoints + k]});
    const reference::HermiteSpline spline(recipe);
    const SplineClock& clock = of.clocks[n];
    const reference::Travel wanted =
        reference::travelAt(spline, {clock.start, clock.duration, clock.active}, kNow, even);
    const auto bounds = reference::tolerance::SplineBounds(recipe, spline).of(wanted, clock.duration, even);
    const double travelled = kind == Kind::motion ? 0 : wanted.travelled;
    worst =
        std::max({worst, glm::distance(glm::dvec3(motions[n].position), wanted.position) / bounds.position,
                  glm::distance(glm::dvec3(motions[n].velocity), wanted.velocity) / bounds.velocity,
                  std::abs(motions[n].travelled - travelled) / bounds.travelled});
  }
  state.counters["error_of_allowed"] = worst;
  if (!(worst <= 1)) state.SkipWithError("the results do not hold");
  return worst <= 1;
}

void finish(benchmark::State& state) {
  using benchmark::Counter;
  state.counters["a_spline"] =
      Counter(double(state.iterations()) * kSplines, Counter::kIsRate | Counter::kInvert);
}

void device(benchmark::State& state, Kind kind) {
  static Device one = Device::create();
  SplineBatch batch(
      one, kSplines,
      {.points = kPoints, .arcLength = kind != Kind::motion, .constantSpeed = kind == Kind::constantSpeed});
  batch.setPoints(work().points, work().knots);
  batch.setClocks(work().clocks);
  batch.travel(kNow);
  if (!hold(state, batch.downloadMotions(), kind)) return;
  for (auto _ : state) batch.travel(kNow);
  finish(state);
}

void scalar(benchmark::State& state, Kind kind) {
  static const std::vector<Cubic> cubics = cubicsOf(work());
  std::vector<SplineMotion> motions(kSplines);
  travelScalar(cubics, work().clocks, kind, motions);
  if (!hold(state, motions, kind)) return;
  for (auto _ : state) {
    travelScalar(cubics, work().clocks, kind, motions);
    benchmark::DoNotOptimize(motions.data());
    benchmark::ClobberMemory();
  }
  finish(state);
}

}  // namespace

int main(int argc, char** argv) {
#if defined(SKITTER_DEBUG_BUILD)
  std::fprintf(stderr,
               "spline_bench: this is a debug build; configure with CMAKE_BUILD_TYPE=RelWithDebInfo\n");
  return 2;
#endif
  for (const Kind kind : {Kind::motion, Kind::arcLength, Kind::constantSpeed})
    for (auto* run : {device, scalar})
      benchmark::RegisterBenchmark(
          (std::string(kindNames[int(kind)]) + (run == device ? "/device" : "/scalar")).c_str(),
          [=](benchmark::State& state) { run(state, kind); })
          ->Unit(benchmark::kMicrosecond)
          ->MeasureProcessCPUTime()
          ->MinTime(0.2)
          ->Repetitions(5)
          ->ReportAggregatesOnly();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  try {
    benchmark::RunSpecifiedBenchmarks();
  } catch (const Error& error) {
    std::fprintf(stderr, "spline_bench: %s\n", error.what());
    return int(error.kind());
  }
}

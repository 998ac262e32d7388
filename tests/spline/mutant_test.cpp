// The comparison with the reference is seen to fail: one small error in a shader (tests/spline/CMakeLists.txt
// says which), and it must refuse.
#include "embedded/broken_clock_comp_storage.h"
#include "embedded/broken_clock_comp_texel.h"
#include "embedded/broken_length_comp_storage.h"
#include "embedded/broken_length_comp_texel.h"
#include "embedded/broken_monotone_comp_storage.h"
#include "embedded/broken_monotone_comp_texel.h"
#include "embedded/broken_newton_comp_storage.h"
#include "embedded/broken_newton_comp_texel.h"
#include "embedded/broken_parabola_comp_storage.h"
#include "embedded/broken_parabola_comp_texel.h"
#include "embedded/broken_point_comp_storage.h"
#include "embedded/broken_point_comp_texel.h"
#include "embedded/broken_tangent_comp_storage.h"
#include "embedded/broken_tangent_comp_texel.h"
#include "embedded/broken_tcb_comp_storage.h"
#include "embedded/broken_tcb_comp_texel.h"
#include "spline/runs.h"
#include "support/gpu_fixture.h"

namespace skitter::test {
namespace {

struct SplineMutant {
  const char *name, *entry;
  SplineRule rule;
  bool closed, constantSpeed;
  std::span<const uint8_t> texel, storage;
};

std::vector<SplineMutant> mutants() {
  using namespace embedded;
  using enum SplineRule;
  return {
      {"point", "travel", zero, false, false, broken_point_comp_texel(), broken_point_comp_storage()},
      {"tangent", "travel", zero, false, false, broken_tangent_comp_texel(), broken_tangent_comp_storage()},
      {"newton", "travel", given, false, true, broken_newton_comp_texel(), broken_newton_comp_storage()},
      {"clock", "travel", given, true, false, broken_clock_comp_texel(), broken_clock_comp_storage()},
      {"length", "lengths", given, false, false, broken_length_comp_texel(), broken_length_comp_storage()},
      {"parabola", "tangents", catmullRom, false, false, broken_parabola_comp_texel(),
       broken_parabola_comp_storage()},
      {"tcb", "tangents", kochanekBartels, false, false, broken_tcb_comp_texel(), broken_tcb_comp_storage()},
      {"monotone", "tangents", monotone, false, false, broken_monotone_comp_texel(),
       broken_monotone_comp_storage()},
  };
}

class SplineMutantTest : public GpuTest, public ::testing::WithParamInterface<SplineMutant> {};

TEST_P(SplineMutantTest, IsRefused) {
  const SplineMutant& mutant = GetParam();
  SplineRun run = randomRun({.points = 6,
                             .closed = mutant.closed,
                             .tangents = {mutant.rule, 0.3f, -0.4f, 0.5f},
                             .constantSpeed = mutant.constantSpeed},
                            256, 40);
  // Long enough for a lost rest to tell.
  if (mutant.closed)
    for (SplineClock& clock : run.clocks) clock.activate(run.now - 10000.37 * clock.duration);
  ASSERT_LE(judge(run, travelled(device(), run)).worst, 1);
  run.options.shaders = {{mutant.entry, mutant.texel, mutant.storage}};
  const Verdict verdict = judge(run, travelled(device(), run));
  EXPECT_GT(verdict.worst, 1) << verdict.text;
  RecordProperty("worst", std::to_string(verdict.worst));
}

INSTANTIATE_TEST_SUITE_P(, SplineMutantTest, ::testing::ValuesIn(mutants()),
                         [](const auto& param) { return std::string(param.param.name); });

}  // namespace
}  // namespace skitter::test

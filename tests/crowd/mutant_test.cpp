// Every check is seen to fail: one small error in a shader (tests/crowd/CMakeLists.txt says which), and
// lock-step replay must refuse its stage and no other. The same situations pass with the sound shaders
// (situation_test.cpp).
#include <algorithm>

#include "broken_includes.inc"
#include "crowd/situations.h"

namespace skitter::test {
namespace {

struct Mutant {
  std::string name, controller, situation, seenIn;
  StageShader shader;
};

const std::vector<Mutant>& mutants() {
  static const std::vector<Mutant> list = {
#include "broken.inc"
  };
  return list;
}

// Broken shaders load through storage buffers, which every device can.
class MutantTest : public GpuTest, public ::testing::WithParamInterface<size_t> {
 protected:
  MutantTest() : GpuTest(LoadPath::storage) {}
};

TEST_P(MutantTest, IsRefused) {
  const Mutant& mutant = mutants()[GetParam()];
  bool found = false;
  for (const validation::StageResult& stage :
       situationNamed(mutant.situation)
           .replayed(device(), controllerNamed(mutant.controller).value(),
                     {.footfalls = UINT32_MAX, .shaders = {mutant.shader}})) {
    if (stage.samples + stage.kept == 0) continue;  // nothing of it before the first refusal
    // Without levels of rate wake decides nothing and has no row. What it does wrong, the stages after it do.
    if (mutant.shader.stage != "wake") {
      EXPECT_EQ(stage.pass, stage.name != mutant.seenIn) << stage.name << ": " << stage.why;
    }
    found = found || !stage.pass;
  }
  EXPECT_TRUE(found);
}

class MutantFidelityTest : public GpuTest {
 protected:
  MutantFidelityTest() : GpuTest(LoadPath::storage) {}
};

// An ik that lets bones pass their limits: the figures say so.
TEST_F(MutantFidelityTest, BrokenLimitsAreSeen) {
  const auto mutant =
      std::find_if(mutants().begin(), mutants().end(), [](const Mutant& m) { return m.name == "ik_limits"; });
  if (mutants().empty()) GTEST_SKIP() << "Made without broken shaders.";
  ASSERT_NE(mutant, mutants().end());
  Crowd crowd(device(), rollingGround(), sceneOf(64), CrowdOptions{.shaders = {mutant->shader}});
  simulate(device(), crowd, 120);
  EXPECT_GT(crowd.fidelity().limitViolation.value(), 1e-3);
  EXPECT_GT(crowd.fidelity().limitViolations.value(), 0);
}

INSTANTIATE_TEST_SUITE_P(, MutantTest, ::testing::Range(size_t{0}, mutants().size()),
                         [](const auto& param) { return mutants()[param.param].name; });

}  // namespace
}  // namespace skitter::test

// The comparison with the reference is seen to fail: one small error in the kernel of trials
// (tests/evolve/CMakeLists.txt says which), and it must refuse.
#include "evolve/trial_parity.h"
#include "support/gpu_fixture.h"
#include "trial_mutants.inc"

namespace skitter::test {
namespace {

struct TrialMutant {
  const char* name;
  TrialShader shader;
};

std::vector<TrialMutant> trialMutants() {
  using namespace embedded;
  return {
#define TRIAL_MUTANT(name) {#name, {broken_##name##_comp_texel(), broken_##name##_comp_storage()}},
      TRIAL_MUTANTS(TRIAL_MUTANT)
#undef TRIAL_MUTANT
  };
}

class TrialMutantTest : public GpuTest, public ::testing::WithParamInterface<TrialMutant> {};
INSTANTIATE_TEST_SUITE_P(, TrialMutantTest, ::testing::ValuesIn(trialMutants()),
                         [](const auto& each) { return each.param.name; });

TEST_P(TrialMutantTest, IsRefused) {
  const Rig rig = spiderRig();
  evolve::Trials trials(device(), rig, 24, 1.0f / 60, GetParam().shader);
  EXPECT_NE(differenceOf(trials, drawnTasks(rig, 24, 1), 30, 24), "");
}

}  // namespace
}  // namespace skitter::test

// Every check is seen to fail: one small error in a shader (tests/crowd/CMakeLists.txt says which), and
// lock-step replay must refuse its stage and no other.
#include "broken_includes.inc"
#include "crowd/simulation.h"

namespace skitter::test {
namespace {

struct Mutant {
  std::string name, controller;
  StageShader shader;
};

const std::vector<Mutant>& mutants() {
  static const std::vector<Mutant> list = {
#include "broken.inc"
  };
  return list;
}

class MutantTest : public GpuTest, public ::testing::WithParamInterface<size_t> {};

TEST_P(MutantTest, IsRefused) {
  const Mutant& mutant = mutants()[GetParam()];
  const Heightfield ground = rollingGround();
  Crowd crowd(device(), ground, sceneOf(64, 1, 1, mutant.controller),
              CrowdOptions{.footfalls = UINT32_MAX, .shaders = {mutant.shader}});
  for (const validation::StageResult& stage : replay(device(), crowd, ground, 60)) {
    EXPECT_EQ(stage.pass, stage.name != mutant.shader.stage) << stage.name << ": " << stage.worst;
  }
}

INSTANTIATE_TEST_SUITE_P(, MutantTest, ::testing::Range(size_t{0}, mutants().size()),
                         [](const auto& param) { return mutants()[param.param].name; });

}  // namespace
}  // namespace skitter::test

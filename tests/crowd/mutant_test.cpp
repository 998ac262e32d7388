// Every check is seen to fail: one small error in a shader (tests/crowd/CMakeLists.txt says which), and
// lock-step replay must refuse its stage and no other.
#include "broken_includes.inc"
#include "crowd/simulation.h"

namespace skitter::test {
namespace {

struct Mutant {
  std::string name, controller;
  StageShader shader;
  bool sleeping;  // seen in a crowd that falls asleep, an agent after the other
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
  Scene scene = sceneOf(mutant.sleeping ? 20 : 64, 1, 1, mutant.controller);
  if (mutant.sleeping) scene.herds[0].goal.kind = Goal::Kind::none;
  Crowd crowd(device(), ground, scene,
              CrowdOptions{.footfalls = UINT32_MAX, .sleep = mutant.sleeping, .shaders = {mutant.shader}});
  if (mutant.sleeping) simulate(device(), crowd, 100);
  bool found = false;
  for (const validation::StageResult& stage : replay(device(), crowd, ground, mutant.sleeping ? 120 : 60)) {
    // wake decides nothing and has no row: what it does wrong, the stages after it do.
    if (mutant.shader.stage != "wake") {
      EXPECT_EQ(stage.pass, stage.name != mutant.shader.stage) << stage.name << ": " << stage.worst;
    }
    found = found || !stage.pass;
  }
  EXPECT_TRUE(found);
}

INSTANTIATE_TEST_SUITE_P(, MutantTest, ::testing::Range(size_t{0}, mutants().size()),
                         [](const auto& param) { return mutants()[param.param].name; });

}  // namespace
}  // namespace skitter::test

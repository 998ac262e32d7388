// The comparison with the reference is seen to fail: one small error in a solver (tests/ik/CMakeLists.txt
// says which), and it must refuse a single iteration.
#include "embedded/broken_active_set_comp_storage.h"
#include "embedded/broken_active_set_comp_texel.h"
#include "embedded/broken_against_comp_storage.h"
#include "embedded/broken_against_comp_texel.h"
#include "embedded/broken_ccd_comp_storage.h"
#include "embedded/broken_ccd_comp_texel.h"
#include "embedded/broken_columns_comp_storage.h"
#include "embedded/broken_columns_comp_texel.h"
#include "embedded/broken_cone_comp_storage.h"
#include "embedded/broken_cone_comp_texel.h"
#include "embedded/broken_dissertation_comp_storage.h"
#include "embedded/broken_dissertation_comp_texel.h"
#include "embedded/broken_ellipse_comp_storage.h"
#include "embedded/broken_ellipse_comp_texel.h"
#include "embedded/broken_fabrik_comp_storage.h"
#include "embedded/broken_fabrik_comp_texel.h"
#include "embedded/broken_free_ccd_comp_storage.h"
#include "embedded/broken_free_ccd_comp_texel.h"
#include "embedded/broken_free_fabrik_comp_storage.h"
#include "embedded/broken_free_fabrik_comp_texel.h"
#include "embedded/broken_free_jacobian_comp_storage.h"
#include "embedded/broken_free_jacobian_comp_texel.h"
#include "embedded/broken_hinge_comp_storage.h"
#include "embedded/broken_hinge_comp_texel.h"
#include "embedded/broken_jacobian_comp_storage.h"
#include "embedded/broken_jacobian_comp_texel.h"
#include "embedded/broken_stretch_align_comp_storage.h"
#include "embedded/broken_stretch_align_comp_texel.h"
#include "embedded/broken_two_bone_comp_storage.h"
#include "embedded/broken_two_bone_comp_texel.h"
#include "ik/runs.h"
#include "support/gpu_fixture.h"

namespace skitter::test {
namespace {

struct Mutant {
  const char *name, *limits;
  ik::Solver solver;
  const char* entry;
  std::span<const uint8_t> texel, storage;
};

std::vector<Mutant> mutants() {
  using namespace embedded;
  using enum ik::Solver;
  return {
      {"free_fabrik", "free", fabrik, "solve_free", broken_free_fabrik_comp_texel(),
       broken_free_fabrik_comp_storage()},
      {"free_ccd", "free", ccd, "solve_free", broken_free_ccd_comp_texel(), broken_free_ccd_comp_storage()},
      {"free_jacobian", "free", dampedLeastSquares, "solve_free", broken_free_jacobian_comp_texel(),
       broken_free_jacobian_comp_storage()},
      {"two_bone", "free", twoBone, "solve_free", broken_two_bone_comp_texel(),
       broken_two_bone_comp_storage()},
      {"stretch_align", "free", stretchAlign, "solve_free", broken_stretch_align_comp_texel(),
       broken_stretch_align_comp_storage()},
      {"dissertation", "cone", dissertationEdge, "solve_free", broken_dissertation_comp_texel(),
       broken_dissertation_comp_storage()},
      {"fabrik", "cone", fabrik, "solve_limited", broken_fabrik_comp_texel(), broken_fabrik_comp_storage()},
      {"active_set", "cone", activeSet, "solve_limited", broken_active_set_comp_texel(),
       broken_active_set_comp_storage()},
      {"columns", "cone", dampedLeastSquares, "solve_limited", broken_columns_comp_texel(),
       broken_columns_comp_storage()},
      {"ccd", "cone", ccd, "solve_limited", broken_ccd_comp_texel(), broken_ccd_comp_storage()},
      {"jacobian", "cone", transpose, "solve_limited", broken_jacobian_comp_texel(),
       broken_jacobian_comp_storage()},
      {"cone", "cone", fabrik, "solve_limited", broken_cone_comp_texel(), broken_cone_comp_storage()},
      {"ellipse", "ellipse", fabrik, "solve_limited", broken_ellipse_comp_texel(),
       broken_ellipse_comp_storage()},
      {"hinge", "hinge", fabrik, "solve_limited", broken_hinge_comp_texel(), broken_hinge_comp_storage()},
  };
}

class MutantTest : public GpuTest, public ::testing::WithParamInterface<Mutant> {};

TEST_P(MutantTest, IsRefused) {
  const Mutant& mutant = GetParam();
  Random random(21);
  const ik::Chain chain = randomChain(mutant.limits, mutant.solver == ik::Solver::twoBone ? 3 : 4, random);
  const ik::Options options{.solver = mutant.solver,
                            .start = ik::Start::previous,
                            .iterations = 1,
                            .restarts = false,
                            .shaders = {{mutant.entry, mutant.texel, mutant.storage}}};
  const validation::IkParity parity =
      checkIkBatch(randomRun(device(), mutant.limits, chain, 256, options, 22));
  EXPECT_GT(parity.worst, 1) << parity.text;
  RecordProperty("worst", std::to_string(parity.worst));
}

INSTANTIATE_TEST_SUITE_P(, MutantTest, ::testing::ValuesIn(mutants()),
                         [](const auto& param) { return std::string(param.param.name); });

// A straight chain with targets as far behind it as its tip is ahead: its bones point straight against their
// rest directions, where one side is as good as another, whatever rounding makes of it.
validation::IkRun foldedBack(Device& device, const ik::Limit& limit, const std::vector<ik::Shader>& shaders) {
  constexpr float far = -0.9995f;  // nearer than 0.999 it would be bent first
  const ik::Chain chain = evenChain(5, 0, limit);
  const ik::Options options{
      .solver = ik::Solver::fabrik, .iterations = 1, .restarts = false, .shaders = shaders};
  return runToward(device, "folded back", chain, options,
                   {{1e-4f, far, 0}, {-1e-4f, far, 0}, {0, far, 1e-4f}, {0, far, -1e-4f}});
}

using FoldedTest = GpuTest;

TEST_F(FoldedTest, IsAsGoodToEverySide) {
  for (const ik::Limit& limit : {ik::Limit(ik::Cone{1}), ik::Limit(ik::Ellipse{0.8f, 1.1f, 0.9f, 1})}) {
    const validation::IkParity sound = checkIkBatch(foldedBack(device(), limit, {}));
    EXPECT_LE(sound.worst, 1) << sound.text;
    EXPECT_EQ(sound.ties, 0u);
    const ik::Shader broken{"solve_limited", embedded::broken_against_comp_texel(),
                            embedded::broken_against_comp_storage()};
    EXPECT_GT(checkIkBatch(foldedBack(device(), limit, {broken})).worst, 1);
  }
}

}  // namespace
}  // namespace skitter::test

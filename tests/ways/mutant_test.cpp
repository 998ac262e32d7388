// The comparison with the reference is seen to fail: one small error in a shader (tests/ways/CMakeLists.txt
// says which), and it must refuse.
#include "embedded/broken_best_comp.h"
#include "embedded/broken_deposit_comp.h"
#include "embedded/broken_length_comp.h"
#include "embedded/broken_roulette_comp.h"
#include "embedded/broken_tie_comp.h"
#include "support/gpu_fixture.h"
#include "ways/maps.h"

namespace skitter::test {
namespace {

struct ColonyMutant {
  const char *name, *entry;
  std::span<const uint8_t> code;
};

std::vector<ColonyMutant> colonyMutants() {
  using namespace embedded;
  return {{"roulette", "walk", broken_roulette_comp()},
          {"length", "walk", broken_length_comp()},
          {"tie", "tighten", broken_tie_comp()},
          {"best", "judge", broken_best_comp()},
          {"deposit", "update", broken_deposit_comp()}};
}

class ColonyMutantTest : public GpuTest, public ::testing::WithParamInterface<ColonyMutant> {};
INSTANTIATE_TEST_SUITE_P(, ColonyMutantTest, ::testing::ValuesIn(colonyMutants()),
                         [](const auto& each) { return each.param.name; });

TEST_P(ColonyMutantTest, IsRefused) {
  ColonyCase each = threatCase(32, 2);
  each.options.shaders = {{GetParam().entry, GetParam().code}};
  Colony colony(device(), each.grid, each.nest, each.goal, each.options);
  reference::Colony truth = referenceOf(each);
  EXPECT_NE(differenceOf(colony, truth, each, 8), "");
}

}  // namespace
}  // namespace skitter::test

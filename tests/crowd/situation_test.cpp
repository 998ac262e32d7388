// Situations in which every stage does all that it can, followed by the reference.
#include <tuple>

#include "crowd/situations.h"

namespace skitter::test {
namespace {

using SituationCase = std::tuple<LoadPath, size_t>;

// Every situation with every controller that can be in it.
struct Sound {
  const Situation* situation;
  Controller controller;
};
const std::vector<Sound>& sound() {
  static const std::vector<Sound> all = [] {
    std::vector<Sound> list;
    for (const Situation& situation : situations())
      for (const Controller controller : situation.controllers) list.push_back({&situation, controller});
    return list;
  }();
  return all;
}

class SituationTest : public GpuTest, public ::testing::WithParamInterface<SituationCase> {
 protected:
  SituationTest() : GpuTest(std::get<0>(GetParam())) {}
};

TEST_P(SituationTest, Passes) {
  const Sound& each = sound()[std::get<1>(GetParam())];
  expectAllPass(each.situation->replayed(device(), each.controller, {.footfalls = UINT32_MAX}));
}

std::string situationName(const ::testing::TestParamInfo<SituationCase>& param) {
  const Sound& each = sound()[std::get<1>(param.param)];
  return std::string(each.situation->name) + "_" + testNameOf(each.controller) +
         (std::get<0>(param.param) == LoadPath::texel ? "_texel" : "_storage");
}

std::vector<size_t> onBothPaths() {
  std::vector<size_t> numbers;
  for (size_t i = 0; i < sound().size(); ++i)
    if (sound()[i].situation->onBothPaths) numbers.push_back(i);
  return numbers;
}

INSTANTIATE_TEST_SUITE_P(, SituationTest,
                         ::testing::Combine(::testing::Values(LoadPath::texel),
                                            ::testing::Range(size_t{0}, sound().size())),
                         situationName);
INSTANTIATE_TEST_SUITE_P(Storage, SituationTest,
                         ::testing::Combine(::testing::Values(LoadPath::storage),
                                            ::testing::ValuesIn(onBothPaths())),
                         situationName);

}  // namespace
}  // namespace skitter::test

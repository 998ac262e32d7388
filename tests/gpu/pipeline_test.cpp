#include "gpu/pipeline.h"

#include "gpu/kernel.h"
#include "support/gpu_fixture.h"

#include <gmock/gmock.h>

#include <set>

namespace skitter::gpu {
namespace {

class PipelinesTest : public ::testing::Test {
 protected:
  // Empty ones, which need no device.
  std::shared_ptr<const Pipeline> of(size_t number) {
    return pipelines_.of(PipelineKey().add(number), [&] {
      ++made_;
      return Pipeline{};
    });
  }

  Pipelines pipelines_;
  size_t made_ = 0;
};

TEST_F(PipelinesTest, OneOfAKeyIsMade) {
  const auto first = of(1), second = of(2);
  EXPECT_NE(first, second);
  EXPECT_EQ(of(1), first);
  EXPECT_EQ(of(2), second);
  EXPECT_EQ(made_, 2u);
}

TEST_F(PipelinesTest, ThoseThatWereNotAskedForAreForgotten) {
  for (size_t i = 0; i < Pipelines::most; ++i) of(i);
  of(0);
  const auto held = of(Pipelines::most);  // in place of 1
  EXPECT_EQ(made_, Pipelines::most + 1);
  of(0);
  EXPECT_EQ(of(Pipelines::most), held);
  EXPECT_EQ(made_, Pipelines::most + 1);
  of(1);
  EXPECT_EQ(made_, Pipelines::most + 2);
}

TEST_F(PipelinesTest, OneThatCannotBeMadeIsTriedAgain) {
  const PipelineKey key = PipelineKey().add("key");
  EXPECT_THROW(pipelines_.of(key, []() -> Pipeline { throw std::runtime_error("no memory"); }),
               std::runtime_error);
  EXPECT_NE(pipelines_.of(key, [] { return Pipeline{}; }), nullptr);
}

TEST(PipelineKeyTest, TextsDoNotRunTogether) {
  EXPECT_NE(PipelineKey().add("ab").add("c").bytes(), PipelineKey().add("a").add("bc").bytes());
}

using PipelineKeyGpuTest = test::GpuTest;

TEST_F(PipelineKeyGpuTest, HoldsAllThatAPipelineIsMadeOf) {
  const std::vector<uint8_t> code{1, 2, 3, 4}, other{1, 2, 3, 5};
  const auto keyOf = [&](const KernelInfo& info) {
    return PipelineKey()
        .add(info.name)
        .add(context(), info.code)
        .add(info.bindings)
        .add(info.pushBytes)
        .add(info.constants)
        .bytes();
  };
  const KernelInfo sound{.name = "copy",
                         .code = {code},
                         .bindings = {{0, BindingKind::load4}, {1, BindingKind::store}},
                         .pushBytes = 8,
                         .constants = {{0, 3}}};
  std::set<std::string> keys{keyOf(sound)};
  const auto addOther = [&](auto change) {
    KernelInfo changed = sound;
    change(changed);
    keys.insert(keyOf(changed));
  };
  addOther([](KernelInfo& info) { info.name = "move"; });
  addOther([&](KernelInfo& info) { info.code = {other}; });
  addOther([](KernelInfo& info) { info.bindings[1].kind = BindingKind::uniform; });
  addOther([](KernelInfo& info) { info.bindings[1].binding = 2; });
  addOther([](KernelInfo& info) { info.bindings.pop_back(); });
  addOther([](KernelInfo& info) { info.pushBytes = 12; });
  addOther([](KernelInfo& info) { info.constants = {{0, 4}}; });
  addOther([](KernelInfo& info) { info.constants = {{1, 3}}; });
  addOther([](KernelInfo& info) { info.constants.clear(); });
  EXPECT_EQ(keys.size(), 10u);
  addOther([](KernelInfo&) {});
  EXPECT_EQ(keys.size(), 10u);
}

}  // namespace
}  // namespace skitter::gpu

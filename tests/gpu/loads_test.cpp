#include "gpu/record_access.h"

#include "gpu/access_cost.h"
#include "support/environment.h"
#include "support/gpu_fixture.h"

#include <gmock/gmock.h>

namespace skitter::gpu {
namespace {

using test::Environment;
using ::testing::HasSubstr;

DeviceLimits able() {
  DeviceLimits limits;
  limits.texelRgba32f = true;
  limits.maxTexelBufferElements = kEnoughTexels;
  return limits;
}

DeviceFeatures wide() { return {.shaderInt64 = true}; }

LoadChoice measured(double texel, double storage) {
  return chooseLoads(able(), wide(), {}, [&] { return LoadCost{texel, storage}; });
}

LoadChoice unmeasured(const DeviceLimits& limits, std::optional<LoadPath> wanted = {},
                      const DeviceFeatures& features = wide()) {
  return chooseLoads(limits, features, wanted, []() -> std::optional<LoadCost> {
    ADD_FAILURE() << "it was measured";
    return {};
  });
}

TEST(LoadChoice, TexelBuffersMustBeMuchQuicker) {
  EXPECT_EQ(measured(1, 2.6).path, LoadPath::texel);
  EXPECT_EQ(measured(1, 1.7).path, LoadPath::texel);
  EXPECT_EQ(measured(1, 1.5).path, LoadPath::storage);
  EXPECT_EQ(measured(1, 1).path, LoadPath::storage);
  EXPECT_EQ(measured(3, 1).path, LoadPath::storage);
}

TEST(LoadChoice, TellsWhatWasMeasured) {
  const LoadChoice choice = measured(2, 5);
  ASSERT_TRUE(choice.cost);
  EXPECT_EQ(choice.cost->texel, 2);
  EXPECT_EQ(choice.cost->storage, 5);
  EXPECT_THAT(choice.why, HasSubstr("2.50"));
}

TEST(LoadChoice, WhatIsAskedForIsTaken) {
  for (const LoadPath path : {LoadPath::texel, LoadPath::storage}) {
    const LoadChoice choice = unmeasured(able(), path);
    EXPECT_EQ(choice.path, path);
    EXPECT_EQ(choice.why, "asked for");
    EXPECT_FALSE(choice.cost);
  }
}

TEST(LoadChoice, UnsuitableTexelBuffersAreNotMeasured) {
  DeviceLimits limits = able();
  limits.texelRgba32f = false;
  EXPECT_EQ(unmeasured(limits).path, LoadPath::storage);
  EXPECT_THAT(unmeasured(limits).why, HasSubstr("RGBA32F"));
  limits = able();
  limits.maxTexelBufferElements = kEnoughTexels - 1;
  EXPECT_EQ(unmeasured(limits).path, LoadPath::storage);
  EXPECT_THAT(unmeasured(limits).why, HasSubstr(std::to_string(kEnoughTexels - 1)));
  EXPECT_EQ(unmeasured(able(), {}, {}).path, LoadPath::storage);
  EXPECT_THAT(unmeasured(able(), {}, {}).why, HasSubstr("shaderInt64"));
}

TEST(LoadChoice, WithoutAClockItIsStorage) {
  const LoadChoice choice = chooseLoads(able(), wide(), {}, [] { return std::nullopt; });
  EXPECT_EQ(choice.path, LoadPath::storage);
  EXPECT_FALSE(choice.cost);
  EXPECT_THAT(choice.why, HasSubstr("timestamps"));
}

TEST(LoadChoice, TheEnvironmentNamesAPathUnlessTheRequestDoes) {
  {
    const Environment loads("SKITTER_LOADS", "texel");
    EXPECT_EQ(wantedLoads({}), LoadPath::texel);
    EXPECT_EQ(wantedLoads(LoadPath::storage), LoadPath::storage);
  }
  const Environment loads("SKITTER_LOADS", "storage");
  EXPECT_EQ(wantedLoads({}), LoadPath::storage);
  EXPECT_EQ(Device::create(test::validatedRequest()).report().loads.path, LoadPath::storage);
}

TEST(LoadChoice, AnUnknownPathInTheEnvironmentIsRefused) {
  const Environment loads("SKITTER_LOADS", "quick");
  try {
    wantedLoads({});
    FAIL() << "it was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    EXPECT_THAT(error.what(), HasSubstr("SKITTER_LOADS is \"quick\", expected texel or storage"));
  }
}

using LoadCostTest = test::GpuTest;

TEST_F(LoadCostTest, DecidesHowADeviceReads) {
  const LoadChoice& made = device().report().loads;
  const LoadChoice expected = chooseLoads(device().report().limits, device().report().features,
                                          wantedLoads({}), [&] { return made.cost; });
  EXPECT_EQ(made.path, expected.path);
  EXPECT_EQ(made.why, expected.why);
  EXPECT_EQ(context().texelLoads(), made.path == LoadPath::texel);
  for (const LoadPath path : {LoadPath::texel, LoadPath::storage})
    if (path == LoadPath::storage || test::hasTexelPath()) {
      EXPECT_EQ(Device::create(test::validatedRequest(path)).report().loads.path, path);
    }
}

TEST_F(LoadCostTest, IsMeasuredByBothPaths) {
  // There the tests of both paths must not be skipped unnoticed.
  if (device().report().name.find("llvmpipe") != std::string::npos) {
    ASSERT_TRUE(test::hasTexelPath());
  }
  if (!test::hasTexelPath()) GTEST_SKIP() << "the device has one load path only";
  const std::optional<LoadCost> cost = measureLoads(context());
  ASSERT_EQ(cost.has_value(), context().isCpu() || context().timestamps());
  if (!cost) GTEST_SKIP() << "the device has no timestamps";
  EXPECT_GT(cost->texel, 0);
  EXPECT_GT(cost->storage, 0);
}

}  // namespace
}  // namespace skitter::gpu

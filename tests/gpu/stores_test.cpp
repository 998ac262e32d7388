#include "gpu/record_access.h"

#include "gpu/access_cost.h"
#include "support/environment.h"
#include "support/gpu_fixture.h"

#include <gmock/gmock.h>

namespace skitter::gpu {
namespace {

using test::Environment;
using ::testing::HasSubstr;

StoreChoice measuredStores(double bits32, double bits64) {
  return chooseStores(LoadPath::texel, {}, [&] { return StoreCost{bits32, bits64}; });
}

StoreChoice unmeasuredStores(LoadPath loads, std::optional<StoreWidth> wanted) {
  return chooseStores(loads, wanted, []() -> std::optional<StoreCost> {
    ADD_FAILURE() << "it was measured";
    return {};
  });
}

TEST(StoreChoice, TheQuickerWidthIsTaken) {
  EXPECT_EQ(measuredStores(5, 4).width, StoreWidth::bits64);
  EXPECT_EQ(measuredStores(4, 5).width, StoreWidth::bits32);
  EXPECT_EQ(measuredStores(4, 4).width, StoreWidth::bits32);
}

TEST(StoreChoice, TellsWhatWasMeasured) {
  const StoreChoice choice = measuredStores(5, 2);
  ASSERT_TRUE(choice.cost);
  EXPECT_EQ(choice.cost->bits32, 5);
  EXPECT_EQ(choice.cost->bits64, 2);
  EXPECT_THAT(choice.why, HasSubstr("2.50"));
}

TEST(StoreChoice, WhatIsAskedForIsTaken) {
  for (const StoreWidth width : {StoreWidth::bits32, StoreWidth::bits64}) {
    const StoreChoice choice = unmeasuredStores(LoadPath::texel, width);
    EXPECT_EQ(choice.width, width);
    EXPECT_EQ(choice.why, "asked for");
    EXPECT_FALSE(choice.cost);
  }
}

TEST(StoreChoice, WithStorageLoadsThereIsOneWidth) {
  EXPECT_EQ(unmeasuredStores(LoadPath::storage, {}).width, StoreWidth::bits32);
  EXPECT_EQ(unmeasuredStores(LoadPath::storage, StoreWidth::bits64).width, StoreWidth::bits32);
}

TEST(StoreChoice, WithoutAClockItIs32) {
  const StoreChoice choice = chooseStores(LoadPath::texel, {}, [] { return std::nullopt; });
  EXPECT_EQ(choice.width, StoreWidth::bits32);
  EXPECT_FALSE(choice.cost);
  EXPECT_THAT(choice.why, HasSubstr("timestamps"));
}

TEST(StoreChoice, TheEnvironmentNamesAWidthUnlessTheRequestDoes) {
  const Environment stores("SKITTER_STORES", "64");
  EXPECT_EQ(wantedStores({}), StoreWidth::bits64);
  EXPECT_EQ(wantedStores(StoreWidth::bits32), StoreWidth::bits32);
}

TEST(StoreChoice, AnUnknownWidthInTheEnvironmentIsRefused) {
  const Environment stores("SKITTER_STORES", "16");
  try {
    wantedStores({});
    FAIL() << "it was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    EXPECT_THAT(error.what(), HasSubstr("SKITTER_STORES is \"16\", expected 32 or 64"));
  }
}

class StoreCostTest : public test::GpuTest {
 protected:
  StoreCostTest() : GpuTest(LoadPath::texel) {}
};

TEST_F(StoreCostTest, DecidesHowADeviceWrites) {
  const StoreChoice& made = device().report().stores;
  const StoreChoice expected = chooseStores(LoadPath::texel, wantedStores({}), [&] { return made.cost; });
  EXPECT_EQ(made.width, expected.width);
  EXPECT_EQ(made.why, expected.why);
  EXPECT_EQ(context().wideStores(), made.width == StoreWidth::bits64);
  for (const StoreWidth width : {StoreWidth::bits32, StoreWidth::bits64}) {
    DeviceRequest request = test::validatedRequest(LoadPath::texel);
    request.stores = width;
    EXPECT_EQ(Device::create(request).report().stores.width, width);
  }
}

TEST_F(StoreCostTest, IsMeasuredByBothWidths) {
  const std::optional<StoreCost> cost = measureStores(context());
  ASSERT_EQ(cost.has_value(), context().isCpu() || context().timestamps());
  if (!cost) GTEST_SKIP() << "the device has no timestamps";
  EXPECT_GT(cost->bits32, 0);
  EXPECT_GT(cost->bits64, 0);
}

}  // namespace
}  // namespace skitter::gpu

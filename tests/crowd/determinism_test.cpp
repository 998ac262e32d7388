// Same device, same scene, same seed, same bits: whatever is paged, measured or read back beside it.
#include "crowd/simulation.h"
#include "gpu/submit.h"

namespace skitter::test {
namespace {

using DeterminismTest = GpuTest;

uint64_t hashAfter(Device& device, const CrowdOptions& options, int ticks, uint64_t seed = 1,
                   Controller controller = Controller::adaptive) {
  Crowd crowd(device, rollingGround(), sceneOf(200, 1, seed, controller), options);
  simulate(device, crowd, ticks);
  return crowd.stateHash();
}

TEST_F(DeterminismTest, TwiceTheSame) { EXPECT_EQ(hashAfter(device(), {}, 90), hashAfter(device(), {}, 90)); }

TEST_F(DeterminismTest, TheSeedMatters) {
  EXPECT_NE(hashAfter(device(), {}, 20), hashAfter(device(), {}, 20, 2));
}

TEST_F(DeterminismTest, PagesDoNotShow) {
  const uint64_t whole = hashAfter(device(), {}, 90);
  EXPECT_EQ(whole, hashAfter(device(), {.pageAgents = 64}, 90));
  EXPECT_EQ(whole, hashAfter(device(), {.pageAgents = 7}, 90));
}

TEST_F(DeterminismTest, MeasuringAndTimingDoNotShow) {
  EXPECT_EQ(hashAfter(device(), {.measure = false}, 60), hashAfter(device(), {.timestamps = true}, 60));
}

TEST_F(DeterminismTest, StagesMadeAtOnceDoNotShow) {
  for (const bool sleep : {false, true})
    EXPECT_EQ(hashAfter(device(), {.sleep = sleep}, 90),
              hashAfter(device(), {.sleep = sleep, .fuse = false}, 90));
}

// All that a caller can ask for beside the simulation.
const CrowdOptions kBare{.pose = false, .measure = false, .fuse = false, .pageAgents = 72};
const CrowdOptions kAll{
    .watchEvery = 1, .feet = true, .footfalls = UINT32_MAX, .timestamps = true, .pageAgents = 24};
const std::pair<const char*, CrowdOptions> kBeside[] = {{"noPose", {.pose = false}},
                                                        {"noMeasure", {.measure = false}},
                                                        {"watchEvery", {.watchEvery = 7}},
                                                        {"feet", {.measure = false, .feet = true}},
                                                        {"footfalls", {.measure = false, .footfalls = 3}},
                                                        {"apart", {.fuse = false}},
                                                        {"bare", kBare},
                                                        {"all", kAll}};

class AskedForBesideTest : public GpuTest, public ::testing::WithParamInterface<Controller> {
 protected:
  uint64_t hash(CrowdOptions options, bool sleep, int ticks = 12) {
    options.sleep = sleep;
    return hashAfter(device(), options, ticks, 1, GetParam());
  }
};

TEST_P(AskedForBesideTest, DoesNotShow) {
  const uint64_t plain = hash({}, false);
  for (const auto& [name, options] : kBeside) EXPECT_EQ(hash(options, false), plain) << name;
  EXPECT_NE(hash({}, false, 13), plain);
}

TEST_P(AskedForBesideTest, DoesNotShowWhereAgentsMaySleep) { EXPECT_EQ(hash(kBare, true), hash(kAll, true)); }

INSTANTIATE_TEST_SUITE_P(, AskedForBesideTest, ::testing::ValuesIn(allControllers),
                         [](const auto& param) { return testNameOf(param.param); });

TEST_F(DeterminismTest, RecordPathsAgreeToTheBit) {
  if (!hasTexelPath()) GTEST_SKIP() << "the device has one load path only";
  const uint64_t expected = hashAfter(device(), {}, 60);
  for (const DeviceRequest& request : everyRecordPath()) {
    Device other = Device::create(request);
    EXPECT_EQ(hashAfter(other, {}, 60), expected)
        << other.report().loads.why << ", " << other.report().stores.why;
    failOnMessages(*other.validationLog());
  }
}

TEST_F(DeterminismTest, SeveralTicksInOneSubmission) {
  Crowd one(device(), rollingGround(), sceneOf(65)), many(device(), rollingGround(), sceneOf(65));
  simulate(device(), one, 8);
  gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
    for (int i = 0; i < 8; ++i) many.record(cmd, kTick);
  });
  EXPECT_EQ(one.stateHash(), many.stateHash());
}

}  // namespace
}  // namespace skitter::test

// Same device, same scene, same seed, same bits: whatever is paged, measured or read back beside it.
#include "crowd/simulation.h"
#include "gpu/submit.h"

namespace skitter::test {
namespace {

using DeterminismTest = GpuTest;

uint64_t hashAfter(Device& device, const CrowdOptions& options, int ticks, uint64_t seed = 1) {
  Crowd crowd(device, rollingGround(), sceneOf(200, 1, seed), options);
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

#include "embedded/copy_comp_storage.h"
#include "embedded/copy_comp_texel.h"
#include "gpu/kernel.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "support/gpu_fixture.h"

#include <gmock/gmock.h>

// That the checks the other tests rely on do see what is wrong.
namespace skitter::gpu {
namespace {

struct PingPush {
  uint32_t count;
  float offset;
};

class ValidationTest : public test::GpuLoadTest {
 protected:
  // Writes b from a, then a from b.
  void ping(bool withBarrier) {
    const Kernel kernel(context(), {.name = "copy",
                                    .code = {embedded::copy_comp_texel(), embedded::copy_comp_storage()},
                                    .bindings = {{0, BindingKind::load4}, {1, BindingKind::store}},
                                    .pushBytes = sizeof(PingPush)});
    const Buffer a(context(), 1024, "a");
    const Buffer b(context(), 1024, "b");
    const Bindings ab = kernel.bind(context(), {{0, &a}, {1, &b}});
    const Bindings ba = kernel.bind(context(), {{0, &b}, {1, &a}});
    submitAndWait(context(), [&](vk::CommandBuffer cmd) {
      kernel.dispatch(cmd, ab, bytesOf(PingPush{64, 0}), 1);
      if (withBarrier) computeToCompute(cmd);
      kernel.dispatch(cmd, ba, bytesOf(PingPush{64, 0}), 1);
    });
  }
};
INSTANTIATE_TEST_SUITE_P(Loads, ValidationTest, test::bothLoadPaths(), test::loadPathName);

TEST_P(ValidationTest, SeesAMissingBarrier) {
  ping(true);
  EXPECT_THAT(device().validationMessages(), ::testing::IsEmpty());
  ping(false);
  const auto messages = device().validationMessages();
  EXPECT_THAT(messages, ::testing::Contains(::testing::Field(
                            &ValidationMessage::id, ::testing::HasSubstr("SYNC-HAZARD-READ-AFTER-WRITE"))));
  log().clear();
}

class MisuseTest : public test::GpuTest {};

TEST_F(MisuseTest, IsReported) {
  submitAndWait(context(), [&](vk::CommandBuffer cmd) {
    // Compute shaders read no vertex attributes; the driver does not mind, the layer must.
    const vk::MemoryBarrier2 wrong{.dstStageMask = vk::PipelineStageFlagBits2::eComputeShader,
                                   .dstAccessMask = vk::AccessFlagBits2::eVertexAttributeRead};
    cmd.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &wrong});
  });
  const auto messages = device().validationMessages();
  EXPECT_THAT(messages,
              ::testing::Contains(::testing::Field(
                  &ValidationMessage::id, ::testing::HasSubstr("VUID-VkMemoryBarrier2-dstAccessMask"))));
  log().clear();
}

TEST(ValidationLog, CountsRepeatsAndOutlivesClear) {
  ValidationLog log;
  log.add("A", "one");
  log.add("A", "one");
  log.add("A", "two");
  ASSERT_EQ(log.messages().size(), 2u);
  EXPECT_EQ(log.messages()[0].count, 2u);
  EXPECT_EQ(log.messages()[1].count, 1u);
  log.clear();
  EXPECT_TRUE(log.messages().empty());
}

}  // namespace
}  // namespace skitter::gpu

#include "gpu/kernel.h"

#include "embedded/arguments_comp.h"
#include "embedded/copy_comp_storage.h"
#include "embedded/copy_comp_texel.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "support/gpu_fixture.h"

#include <gmock/gmock.h>

namespace skitter::gpu {
namespace {

struct CopyPush {
  uint32_t count;
  float offset;
};

using Record = std::array<float, 4>;

class KernelTest : public test::GpuLoadTest {
 protected:
  Kernel makeCopy(int32_t scale) {
    return {context(),
            {.name = "copy",
             .code = {embedded::copy_comp_texel(), embedded::copy_comp_storage()},
             .bindings = {{0, BindingKind::load4}, {1, BindingKind::store}},
             .pushBytes = sizeof(CopyPush),
             .constants = {{0, scale}}}};
  }
};
INSTANTIATE_TEST_SUITE_P(Loads, KernelTest, test::bothLoadPaths(), test::loadPathName);

std::vector<Record> records(uint32_t count) {
  std::vector<Record> list(count);
  for (uint32_t i = 0; i < count; ++i) list[i] = {float(i), float(i) + 0.25f, -float(i), 1.5f};
  return list;
}

Record expected(const Record& in, int32_t scale, float offset) {
  Record out;
  for (size_t k = 0; k < 4; ++k) out[k] = in[k] * float(scale) + offset;
  return out;
}

TEST_P(KernelTest, WritesExactlyItsItems) {
  const Kernel kernel = makeCopy(3);
  for (const uint32_t count : {0u, 1u, 63u, 64u, 65u, 1234u}) {
    const auto in = records(count);
    const Buffer source(context(), count * sizeof(Record), "source");
    // One record more than is asked for, which must stay as it is.
    const Buffer target(context(), (count + 1) * sizeof(Record), "target");
    upload(context(), source, in);
    clear(context(), target);
    const Bindings bindings = kernel.bind(context(), {{0, &source}, {1, &target}});
    submitAndWait(context(), [&](vk::CommandBuffer cmd) {
      kernel.dispatch(cmd, bindings, bytesOf(CopyPush{count, 0.5f}), groupsFor(count, 64));
    });
    const auto out = download<Record>(context(), target);
    ASSERT_EQ(out.size(), count + 1);
    for (uint32_t i = 0; i < count; ++i) ASSERT_EQ(out[i], expected(in[i], 3, 0.5f)) << i << " of " << count;
    EXPECT_EQ(out[count], Record{}) << count;
  }
}

// Compute after compute after compute in one submission, through the barrier that the crowd uses.
TEST_P(KernelTest, StagesFeedEachOther) {
  const uint32_t count = 1234;
  const Kernel kernel = makeCopy(1);
  const Buffer a(context(), count * sizeof(Record), "a");
  const Buffer b(context(), count * sizeof(Record), "b");
  upload(context(), a, records(count));
  const Bindings ab = kernel.bind(context(), {{0, &a}, {1, &b}});
  const Bindings ba = kernel.bind(context(), {{0, &b}, {1, &a}});
  submitAndWait(context(), [&](vk::CommandBuffer cmd) {
    for (int i = 0; i < 3; ++i) {
      kernel.dispatch(cmd, ab, bytesOf(CopyPush{count, 1}), groupsFor(count, 64));
      computeToCompute(cmd);
      kernel.dispatch(cmd, ba, bytesOf(CopyPush{count, 1}), groupsFor(count, 64));
      computeToCompute(cmd);
    }
  });
  const auto in = records(count);
  const auto out = download<Record>(context(), a);
  for (uint32_t i = 0; i < count; ++i) EXPECT_EQ(out[i], expected(in[i], 1, 6));
}

TEST_P(KernelTest, CountsWrittenByComputeDispatchIndirectly) {
  const uint32_t count = 200;
  const Kernel kernel = makeCopy(1);
  const Kernel arguments(context(), {.name = "arguments",
                                     .code = embedded::arguments_comp(),
                                     .bindings = {{0, BindingKind::store}},
                                     .pushBytes = 4});
  const Buffer groups(context(), 12, "groups", BufferUse::indirect);
  const Buffer source(context(), count * sizeof(Record), "source");
  const Buffer target(context(), count * sizeof(Record), "target");
  const HostBuffer results(context(), target.size(), HostUse::readback, "results");
  upload(context(), source, records(count));
  const Bindings set = arguments.bind(context(), {{0, &groups}});
  const Bindings copy = kernel.bind(context(), {{0, &source}, {1, &target}});
  submitAndWait(context(), [&](vk::CommandBuffer cmd) {
    cmd.fillBuffer(target.handle(), 0, VK_WHOLE_SIZE, 0);
    transferToCompute(cmd);
    arguments.dispatch(cmd, set, bytesOf(uint32_t(2)), 1);
    computeToIndirectAndCompute(cmd);
    kernel.dispatchIndirect(cmd, copy, bytesOf(CopyPush{count, 0}), groups);
    computeToTransfer(cmd);
    cmd.copyBuffer(target.handle(), results.handle(), vk::BufferCopy{.size = target.size()});
    transferToHost(cmd);
  });
  const auto in = records(count);
  const auto out = results.as<Record>();
  for (uint32_t i = 0; i < count; ++i) EXPECT_EQ(out[i], i < 128 ? in[i] : Record{}) << i;
}

TEST_P(KernelTest, BindingBeyondTheDevicesReachIsRefused) {
  const uint64_t bytes = context().limits().maxStorageBufferRange + 16;
  if (bytes > context().limits().availableBytes || bytes > context().limits().maxAllocationBytes) {
    GTEST_SKIP() << "the device cannot hold a buffer that it could not reach";
  }
  const Kernel kernel = makeCopy(1);
  const Buffer source(context(), 16, "source");
  const Buffer target(context(), bytes, "huge target");
  try {
    const Bindings bindings = kernel.bind(context(), {{0, &source}, {1, &target}});
    FAIL() << "it was bound";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::device);
    EXPECT_THAT(error.what(),
                ::testing::AllOf(::testing::HasSubstr("huge target"), ::testing::HasSubstr("copy")));
  }
}

}  // namespace
}  // namespace skitter::gpu

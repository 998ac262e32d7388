#include "gpu/submit.h"

#include "gpu/barrier.h"
#include "gpu/buffer.h"
#include "gpu/spares.h"
#include "gpu/timer.h"
#include "gpu/transfer.h"
#include "support/gpu_fixture.h"

#include <gmock/gmock.h>

#include <chrono>
#include <stdexcept>

namespace skitter::gpu {
namespace {

class SubmitTest : public test::GpuTest {};

TEST_F(SubmitTest, RingKeepsOrderAndCounts) {
  const HostBuffer counter(context(), 4 * 8, HostUse::readback, "counter");
  CommandRing ring(context(), 3);
  EXPECT_EQ(ring.completed(), 0u);
  for (uint32_t i = 0; i < 8; ++i) {
    const vk::CommandBuffer cmd = ring.begin();
    EXPECT_EQ(ring.slot(), i % 3);
    cmd.fillBuffer(counter.handle(), 4 * i, 4, i + 1);
    transferToHost(cmd);
    EXPECT_EQ(ring.submit(), i + 1);
  }
  ring.wait(3);
  EXPECT_GE(ring.completed(), 3u);
  ring.waitAll();
  EXPECT_EQ(ring.completed(), 8u);
  EXPECT_THAT(counter.as<uint32_t>(), ::testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
}

TEST_F(SubmitTest, RingMayEndInFlight) {
  const Buffer buffer(context(), 1 << 20, "filled");
  CommandRing ring(context());
  ring.begin().fillBuffer(buffer.handle(), 0, VK_WHOLE_SIZE, 1);
  ring.submit();
}

TEST_F(SubmitTest, TimersAreMonotone) {
  StageTimer timer(context(), 4);
  const Buffer buffer(context(), 32 << 20, "timed");
  const auto before = std::chrono::steady_clock::now();
  submitAndWait(context(), [&](vk::CommandBuffer cmd) {
    timer.reset(cmd);
    timer.begin(cmd, "all");
    timer.begin(cmd, "first");
    cmd.fillBuffer(buffer.handle(), 0, VK_WHOLE_SIZE, 1);
    timer.end(cmd, "first");
    transferToTransfer(cmd);
    timer.begin(cmd, "second");
    cmd.fillBuffer(buffer.handle(), 0, VK_WHOLE_SIZE, 2);
    timer.end(cmd, "second");
    timer.end(cmd, "all");
  });
  const std::chrono::duration<double, std::milli> host = std::chrono::steady_clock::now() - before;
  const auto times = timer.milliseconds();
  ASSERT_EQ(timer.measures(), context().timestamps());
  if (!timer.measures()) return;
  ASSERT_EQ(times.size(), 3u);
  EXPECT_EQ(times[0].stage, "all");
  EXPECT_EQ(times[1].stage, "first");
  EXPECT_EQ(times[2].stage, "second");
  for (const StageTime& time : times) EXPECT_GE(time.milliseconds, 0) << time.stage;
  EXPECT_GE(times[0].milliseconds, times[1].milliseconds + times[2].milliseconds);
  EXPECT_LE(times[0].milliseconds, host.count());
}

TEST_F(SubmitTest, StagesInARowShareTheirTimestamps) {
  StageTimer timer(context(), 3);
  const Buffer buffer(context(), 32 << 20, "timed");
  submitAndWait(context(), [&](vk::CommandBuffer cmd) {
    timer.reset(cmd);
    timer.begin(cmd, "all");
    timer.begin(cmd, "first");
    cmd.fillBuffer(buffer.handle(), 0, VK_WHOLE_SIZE, 1);
    transferToTransfer(cmd);
    timer.next(cmd, "second");
    cmd.fillBuffer(buffer.handle(), 0, VK_WHOLE_SIZE, 2);
    timer.end(cmd, "second");
    timer.end(cmd, "all");
  });
  if (!timer.measures()) return;
  const auto times = timer.milliseconds();
  ASSERT_EQ(times.size(), 3u);
  EXPECT_EQ(times[1].stage, "first");
  EXPECT_EQ(times[2].stage, "second");
  for (size_t i : {1u, 2u}) EXPECT_GT(times[i].milliseconds, 0) << times[i].stage;
  EXPECT_GE(times[0].milliseconds, times[1].milliseconds + times[2].milliseconds);
}

TEST_F(SubmitTest, DisabledTimerIsSilent) {
  StageTimer off(context(), 4, false);
  StageTimer none;
  submitAndWait(context(), [&](vk::CommandBuffer cmd) {
    for (StageTimer* timer : {&off, &none}) {
      timer->reset(cmd);
      timer->next(cmd, "stage");
      timer->next(cmd, "next");
      timer->end(cmd, "next");
    }
  });
  EXPECT_TRUE(off.milliseconds().empty());
  EXPECT_TRUE(none.milliseconds().empty());
}

TEST_F(SubmitTest, OneMayBeMadeWithinAnother) {
  const Buffer outer(context(), 16, "outer"), inner(context(), 16, "inner");
  submitAndWait(context(), [&](vk::CommandBuffer cmd) {
    cmd.fillBuffer(outer.handle(), 0, VK_WHOLE_SIZE, 1);
    upload(context(), inner, std::vector<uint32_t>(4, 2));
  });
  EXPECT_THAT(download<uint32_t>(context(), outer), ::testing::Each(1u));
  EXPECT_THAT(download<uint32_t>(context(), inner), ::testing::Each(2u));
}

TEST_F(SubmitTest, WhatFailsIsNotUsedAgain) {
  const Buffer buffer(context(), 16, "filled");
  upload(context(), buffer, std::vector<uint32_t>(4, 1));
  EXPECT_THROW(submitAndWait(context(),
                             [&](vk::CommandBuffer cmd) {
                               cmd.fillBuffer(buffer.handle(), 0, VK_WHOLE_SIZE, 2);
                               throw std::runtime_error("recording failed");
                             }),
               std::runtime_error);
  EXPECT_THAT(download<uint32_t>(context(), buffer), ::testing::Each(1u));
}

TEST_F(SubmitTest, SparesAreKeptForTheNextCopy) {
  Spares spares;
  std::unique_ptr<CommandRing> commands = spares.commands(context());
  const CommandRing* const ring = commands.get();
  spares.giveBack(std::move(commands));
  commands = spares.commands(context());
  EXPECT_EQ(commands.get(), ring);
  EXPECT_NE(spares.commands(context()).get(), ring);

  std::unique_ptr<HostBuffer> staging = spares.staging(context(), 100000, HostUse::upload);
  const HostBuffer* const buffer = staging.get();
  EXPECT_GE(staging->size(), 100000u);
  spares.giveBack(std::move(staging), HostUse::upload);
  EXPECT_NE(spares.staging(context(), 100, HostUse::readback).get(), buffer);
  // A smaller one does not take the place of a larger one, and one that is too small is not taken.
  staging = spares.staging(context(), 1 << 20, HostUse::upload);
  EXPECT_NE(staging.get(), buffer);
  EXPECT_GE(staging->size(), 1u << 20);
  const HostBuffer* const larger = staging.get();
  std::unique_ptr<HostBuffer> smaller = spares.staging(context(), 100, HostUse::upload);
  EXPECT_EQ(smaller.get(), buffer);
  spares.giveBack(std::move(staging), HostUse::upload);
  spares.giveBack(std::move(smaller), HostUse::upload);
  EXPECT_EQ(spares.staging(context(), 100, HostUse::upload).get(), larger);
}

TEST_F(SubmitTest, LargeStagingIsNotKept) {
  Spares spares;
  std::unique_ptr<HostBuffer> staging = spares.staging(context(), Spares::mostStaging + 1, HostUse::upload);
  EXPECT_EQ(staging->size(), Spares::mostStaging + 1);
  spares.giveBack(std::move(staging), HostUse::upload);
  EXPECT_LE(spares.staging(context(), 16, HostUse::upload)->size(), Spares::mostStaging);
}

}  // namespace
}  // namespace skitter::gpu

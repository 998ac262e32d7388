#include "gpu/submit.h"

#include "gpu/spares.h"

#include <array>
#include <cassert>

namespace skitter::gpu {
namespace {

vk::raii::CommandPool makePool(const Context& context) {
  return {context.device(), vk::CommandPoolCreateInfo{.flags = vk::CommandPoolCreateFlagBits::eTransient,
                                                      .queueFamilyIndex = context.queueFamily()}};
}

vk::CommandBuffer makeCommands(const Context& context, const vk::raii::CommandPool& pool) {
  return (*context.device())
      .allocateCommandBuffers(
          {.commandPool = *pool, .level = vk::CommandBufferLevel::ePrimary, .commandBufferCount = 1})
      .front();
}

}  // namespace

CommandRing::CommandRing(const Context& context, uint32_t slots) : context_(context), frames_(slots) {
  assert(slots > 0);
  guarded("the command ring", [&] {
    for (Frame& frame : frames_) {
      frame.pool = makePool(context);
      frame.cmd = makeCommands(context, frame.pool);
    }
    const vk::SemaphoreTypeCreateInfo timeline{.semaphoreType = vk::SemaphoreType::eTimeline,
                                               .initialValue = 0};
    timeline_ = vk::raii::Semaphore(context.device(), vk::SemaphoreCreateInfo{.pNext = &timeline});
  });
  context.name(*timeline_, "command ring");
  slot_ = slots - 1;
}

CommandRing::~CommandRing() {
  try {
    waitAll();
  } catch (const Error&) {  // a lost device runs nothing any more
  }
}

vk::CommandBuffer CommandRing::begin() {
  assert(!recording_);
  slot_ = (slot_ + 1) % slots();
  Frame& frame = frames_[slot_];
  wait(frame.value);
  guarded("recording commands", [&] {
    frame.pool.reset();
    frame.cmd.begin(vk::CommandBufferBeginInfo{.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  });
  recording_ = true;
  return frame.cmd;
}

uint64_t CommandRing::submit(const SubmitLinks& links) {
  assert(recording_);
  recording_ = false;
  Frame& frame = frames_[slot_];
  const uint64_t value = submitted_ + 1;
  const vk::SemaphoreSubmitInfo wait{.semaphore = links.wait, .stageMask = links.waitStage};
  const std::array signals{
      vk::SemaphoreSubmitInfo{
          .semaphore = *timeline_, .value = value, .stageMask = vk::PipelineStageFlagBits2::eAllCommands},
      vk::SemaphoreSubmitInfo{.semaphore = links.signal,
                              .stageMask = vk::PipelineStageFlagBits2::eAllCommands}};
  const vk::CommandBufferSubmitInfo commands{.commandBuffer = frame.cmd};
  guarded("submitting commands", [&] {
    frame.cmd.end();
    context_.queue()->submit2(vk::SubmitInfo2{.waitSemaphoreInfoCount = links.wait ? 1u : 0u,
                                              .pWaitSemaphoreInfos = &wait,
                                              .commandBufferInfoCount = 1,
                                              .pCommandBufferInfos = &commands,
                                              .signalSemaphoreInfoCount = links.signal ? 2u : 1u,
                                              .pSignalSemaphoreInfos = signals.data()});
  });
  submitted_ = value;
  frame.value = value;
  return value;
}

void CommandRing::wait(uint64_t value) const {
  assert(value <= submitted_);
  if (value == 0) return;
  const vk::Semaphore semaphore = *timeline_;
  guarded("waiting for commands", [&] {
    const vk::Result result =
        (*context_.device())
            .waitSemaphores({.semaphoreCount = 1, .pSemaphores = &semaphore, .pValues = &value}, UINT64_MAX);
    if (result != vk::Result::eSuccess) throw deviceError("waiting for commands: " + vk::to_string(result));
  });
}

uint64_t CommandRing::completed() const {
  return guarded("asking for the commands' progress", [&] { return timeline_.getCounterValue(); });
}

void submitAndWait(const Context& context, const std::function<void(vk::CommandBuffer)>& record) {
  std::unique_ptr<CommandRing> ring = context.spares().commands(context);
  record(ring->begin());
  ring->wait(ring->submit());
  context.spares().giveBack(std::move(ring));
}

}  // namespace skitter::gpu

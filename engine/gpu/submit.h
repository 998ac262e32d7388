#pragma once

#include "gpu/context.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace skitter::gpu {

// Semaphores that a submission waits for and signals beside its own timeline: a swapchain's.
struct SubmitLinks {
  vk::Semaphore wait = {};
  vk::PipelineStageFlags2 waitStage = vk::PipelineStageFlagBits2::eColorAttachmentOutput;
  vk::Semaphore signal = {};
};

// Command buffers that are recorded while earlier ones still run. begin() waits only when all are in flight.
class CommandRing {
 public:
  explicit CommandRing(const Context&, uint32_t slots = 2);
  // Waits for what is in flight; a failing device is not reported here.
  ~CommandRing();
  CommandRing(const CommandRing&) = delete;
  CommandRing& operator=(const CommandRing&) = delete;

  // A fresh command buffer in recording state. Throws Error(device) when the device is lost.
  vk::CommandBuffer begin();
  // Ends and submits what begin() gave; the value is what wait() and semaphore() count by, from 1 on.
  uint64_t submit(const SubmitLinks& = {});

  // The slot of the last begin(), for whatever else exists once per slot (timers, uniforms).
  uint32_t slot() const { return slot_; }
  uint32_t slots() const { return uint32_t(frames_.size()); }

  void wait(uint64_t value) const;
  void waitAll() const { wait(submitted_); }
  uint64_t submitted() const { return submitted_; }
  uint64_t completed() const;
  // Timeline, signalled to submit()'s value.
  vk::Semaphore semaphore() const { return *timeline_; }

 private:
  struct Frame {
    vk::raii::CommandPool pool = nullptr;
    vk::CommandBuffer cmd;  // goes with its pool
    uint64_t value = 0;     // of its last submission
  };
  const Context& context_;
  std::vector<Frame> frames_;
  vk::raii::Semaphore timeline_ = nullptr;
  uint64_t submitted_ = 0;
  uint32_t slot_ = 0;
  bool recording_ = false;
};

// Records, submits and waits: for set-up and tools, never in the frame loop.
void submitAndWait(const Context&, const std::function<void(vk::CommandBuffer)>& record);

}  // namespace skitter::gpu

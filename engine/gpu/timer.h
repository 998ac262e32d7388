#pragma once

#include "gpu/context.h"

#include <string>
#include <vector>

namespace skitter::gpu {

struct StageTime {
  std::string stage;
  double milliseconds = 0;
};

// Device time per named stage, by timestamps, with a debug label around each stage. One timer serves one
// command buffer in flight: keep one per slot of a CommandRing. When disabled, or where the queue has no
// timestamps, only the labels remain and milliseconds() is empty. Software devices may lie: measure host time
// beside it.
class StageTimer {
 public:
  StageTimer() = default;
  StageTimer(const Context&, uint32_t maxStages, bool enabled = true);

  // Whether it measures from the next reset() on, where it can; at first it does.
  void measure(bool on) { wanted_ = on; }
  // First in the command buffer, before any begin().
  void reset(vk::CommandBuffer);
  // Stages may nest. The same name twice is two entries. Beyond maxStages a caller's bug. `stage`
  // outlives the timer's use.
  void begin(vk::CommandBuffer, const char* stage);
  void end(vk::CommandBuffer, const char* stage);
  // Ends the stage that is open, if one is, and begins another at the same timestamp: on a software device
  // one costs as much as a small dispatch.
  void next(vk::CommandBuffer, const char* stage);

  // The times since the last reset(), in the order of begin(), once the submission is complete.
  std::vector<StageTime> milliseconds() const;
  bool measures() const { return measuring_ && !!*pool_; }

 private:
  struct Entry {
    const char* stage;
    uint32_t began, ended;  // queries
  };
  static constexpr uint32_t kOpen = UINT32_MAX;
  uint32_t stamp(vk::CommandBuffer);
  Entry* open();

  const Context* context_ = nullptr;
  uint32_t maxStages_ = 0;
  vk::raii::QueryPool pool_ = nullptr;
  bool wanted_ = true, measuring_ = true;  // the latter of the commands since the last reset()
  std::vector<Entry> entries_;
  uint32_t stamps_ = 0;  // since reset()
};

}  // namespace skitter::gpu

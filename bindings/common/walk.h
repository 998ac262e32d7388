#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "skitter/crowd.h"

namespace skitter::bindings {

// Makes ticks on the device's queue: one is recorded while the device still runs the one before it.
class Walk {
 public:
  explicit Walk(const Device& device);
  ~Walk();

  // Returns when the device has made all of them. `goOn`, if any, is asked before each; when it says no, the
  // ticks so far are waited for and their number is returned. Throws what Crowd::record and `goOn` throw; the
  // ticks so far are done then, and the crowd stays usable.
  uint64_t step(Crowd& crowd, uint64_t ticks, float dt, const std::function<bool()>& goOn = {});
  // Records commands and submits them. Waits only where the last two submissions are still on their way, for
  // the earlier one.
  void submit(const std::function<void(VkCommandBuffer)>& record);
  // The same, and waits.
  void run(const std::function<void(VkCommandBuffer)>& record);
  // For all that was submitted.
  void wait();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skitter::bindings

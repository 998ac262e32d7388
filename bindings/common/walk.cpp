#include "bindings/common/walk.h"

#include "gpu/submit.h"

namespace skitter::bindings {

struct Walk::Impl {
  gpu::CommandRing ring;

  void submit(const std::function<void(VkCommandBuffer)>& record) {
    const vk::CommandBuffer cmd = ring.begin();
    try {
      record(cmd);
    } catch (...) {
      ring.submit();  // the ring goes on with the next command buffer
      throw;
    }
    ring.submit();
  }
};

Walk::Walk(const Device& device) : impl_(new Impl{gpu::CommandRing(device.context())}) {}
Walk::~Walk() = default;

uint64_t Walk::step(Crowd& crowd, uint64_t ticks, float dt, const std::function<bool()>& goOn) {
  uint64_t done = 0;
  try {
    while (done < ticks && (!goOn || goOn())) {
      impl_->submit([&](VkCommandBuffer cmd) { crowd.record(cmd, dt); });
      ++done;
    }
  } catch (...) {
    impl_->ring.waitAll();
    throw;
  }
  impl_->ring.waitAll();
  return done;
}

void Walk::submit(const std::function<void(VkCommandBuffer)>& record) { impl_->submit(record); }

void Walk::run(const std::function<void(VkCommandBuffer)>& record) {
  impl_->submit(record);
  impl_->ring.waitAll();
}

void Walk::wait() { impl_->ring.waitAll(); }

}  // namespace skitter::bindings

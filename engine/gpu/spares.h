#pragma once

#include "gpu/buffer.h"
#include "gpu/submit.h"

#include <memory>
#include <mutex>

// Spares keep what a copy between host and device needs for a moment, so that the next copy need not make it
// anew: a driver may take milliseconds for that. Threads may call it at once.
namespace skitter::gpu {

class Spares {
 public:
  // Staging memory beyond this is made for one use.
  static constexpr uint64_t mostStaging = 8ull << 20;

  // One slot, nothing in flight.
  std::unique_ptr<CommandRing> commands(const Context&);
  // At least `bytes`.
  std::unique_ptr<HostBuffer> staging(const Context&, uint64_t bytes, HostUse);

  // Nothing that failed is given back.
  void giveBack(std::unique_ptr<CommandRing>);
  void giveBack(std::unique_ptr<HostBuffer>, HostUse);

 private:
  std::unique_ptr<HostBuffer>& stagingFor(HostUse use) {
    return use == HostUse::upload ? upload_ : readback_;
  }

  std::mutex mutex_;
  std::unique_ptr<CommandRing> commands_;
  std::unique_ptr<HostBuffer> upload_, readback_;
};

}  // namespace skitter::gpu

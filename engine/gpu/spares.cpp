#include "gpu/spares.h"

#include <algorithm>
#include <bit>

namespace skitter::gpu {

std::unique_ptr<CommandRing> Spares::commands(const Context& context) {
  {
    const std::lock_guard lock(mutex_);
    if (commands_) return std::move(commands_);
  }
  return std::make_unique<CommandRing>(context, 1);
}

std::unique_ptr<HostBuffer> Spares::staging(const Context& context, uint64_t bytes, HostUse use) {
  {
    const std::lock_guard lock(mutex_);
    if (std::unique_ptr<HostBuffer>& spare = stagingFor(use); spare && spare->size() >= bytes)
      return std::move(spare);
  }
  constexpr uint64_t least = 64 << 10;
  const uint64_t made = bytes > mostStaging ? bytes : std::bit_ceil(std::max(bytes, least));
  return std::make_unique<HostBuffer>(context, made, use,
                                      use == HostUse::upload ? "upload staging" : "download staging");
}

void Spares::giveBack(std::unique_ptr<CommandRing> commands) {
  const std::lock_guard lock(mutex_);
  commands_ = std::move(commands);
}

void Spares::giveBack(std::unique_ptr<HostBuffer> staging, HostUse use) {
  if (staging->size() > mostStaging) return;
  const std::lock_guard lock(mutex_);
  std::unique_ptr<HostBuffer>& spare = stagingFor(use);
  if (!spare || spare->size() < staging->size()) spare = std::move(staging);
}

}  // namespace skitter::gpu

#include "crowd/edit.h"

#include <algorithm>

#include "crowd/herd.h"

namespace skitter {
namespace crowd {
namespace {

// The most that vkCmdUpdateBuffer takes; a row of the widest terrain.
constexpr uint32_t kMostSamples = 16384;
// A foot that cannot step at once waits for its neighbours' swings.
constexpr double kWatchSeconds = 2;

}  // namespace

HeightEdits::HeightEdits(const gpu::Context& context)
    : staging_(context, kMostSamples * sizeof(float), "height edits") {
  packed_.reserve(kMostSamples);
}

void HeightEdits::record(vk::CommandBuffer cmd, const Heightfield& terrain, const gpu::Image& image,
                         gpu::ImageState between) {
  gpu::transition(cmd, image, between, gpu::ImageState::transferDst);
  for (const Rectangle& r : pending_) {
    const uint32_t most = kMostSamples / r.columns;
    for (uint32_t row = 0; row < r.rows; row += most) {
      const uint32_t rows = std::min(most, r.rows - row);
      packed_.clear();
      for (uint32_t z = r.z + row; z < r.z + row + rows; ++z) {
        const auto first = terrain.heights.begin() + static_cast<std::ptrdiff_t>(z) * terrain.columns + r.x;
        packed_.insert(packed_.end(), first, first + r.columns);
      }
      gpu::transferToTransfer(cmd);
      cmd.updateBuffer(staging_.handle(), 0, packed_.size() * sizeof(float), packed_.data());
      gpu::transferToTransfer(cmd);
      cmd.copyBufferToImage(staging_.handle(), image.handle(), gpu::layoutOf(gpu::ImageState::transferDst),
                            vk::BufferImageCopy{.imageSubresource = {image.aspect(), 0, 0, 1},
                                                .imageOffset = {int32_t(r.x), int32_t(r.z + row), 0},
                                                .imageExtent = {r.columns, rows, 1}});
    }
  }
  gpu::transition(cmd, image, gpu::ImageState::transferDst, between);
  pending_.clear();
}

}  // namespace crowd

void Crowd::editHeights(uint32_t x0, uint32_t z0, uint32_t columns, uint32_t rows,
                        std::span<const float> heights) {
  impl_->terrain.edit(x0, z0, columns, rows, heights);
  if (columns == 0 || rows == 0) return;
  impl_->edits.add(x0, z0, columns, rows);
  const double dt = impl_->dt > 0 ? impl_->dt : 1.0 / 60;
  impl_->watchUntil = impl_->tick + 1 + static_cast<uint64_t>(crowd::kWatchSeconds / dt);
}

const Heightfield& Crowd::terrain() const { return impl_->terrain; }

}  // namespace skitter

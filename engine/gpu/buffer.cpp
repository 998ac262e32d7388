#include "gpu/buffer.h"

#include <fmt/format.h>
#include <cassert>

#include <algorithm>

namespace skitter::gpu {
namespace {

constexpr uint64_t kTexelBytes = 16;

// Whole texels, so that a view reaches the last bytes too.
uint64_t allocatedBytes(uint64_t bytes) {
  return std::max(kTexelBytes, (bytes + kTexelBytes - 1) / kTexelBytes * kTexelBytes);
}

void checkSize(const Context& context, uint64_t bytes, const std::string& name) {
  const uint64_t most = context.limits().maxAllocationBytes;
  if (bytes > most - kTexelBytes) {
    throw deviceError(
        fmt::format("out of device memory: \"{}\" needs {:.1f} MiB, {} allows {:.1f} MiB in a buffer", name,
                    double(bytes) / (1 << 20), context.report().name, double(most) / (1 << 20)));
  }
}

vk::raii::Buffer makeBuffer(const Context& context, uint64_t bytes, vk::BufferUsageFlags usage,
                            const std::string& name) {
  auto buffer = guarded("the buffer \"" + name + "\"", [&] {
    return vk::raii::Buffer(context.device(), vk::BufferCreateInfo{.size = bytes, .usage = usage});
  });
  context.name(*buffer, name);
  return buffer;
}

}  // namespace

Buffer::Buffer(const Context& context, uint64_t bytes, std::string name, BufferUse use)
    : context_(&context), bytes_(bytes), name_(std::move(name)) {
  using Usage = vk::BufferUsageFlagBits;
  checkSize(context, bytes_, name_);
  vk::BufferUsageFlags usage = Usage::eStorageBuffer | Usage::eTransferSrc | Usage::eTransferDst;
  if (context.texelLoads()) usage |= Usage::eUniformTexelBuffer;
  if (has(use, BufferUse::indirect)) usage |= Usage::eIndirectBuffer;
  if (has(use, BufferUse::vertex)) usage |= Usage::eVertexBuffer;
  if (has(use, BufferUse::index)) usage |= Usage::eIndexBuffer;
  if (has(use, BufferUse::uniform)) usage |= Usage::eUniformBuffer;
  buffer_ = makeBuffer(context, bound(), usage, name_);
  memory_ =
      context.allocate(buffer_.getMemoryRequirements(), vk::MemoryPropertyFlagBits::eDeviceLocal, {}, name_);
  context.name(*memory_, name_);
  guarded(name_, [&] { buffer_.bindMemory(*memory_, 0); });
}

Buffer Buffer::borrowed(const Context& context, vk::Buffer handle, uint64_t bytes, std::string name,
                        uint64_t offset) {
  Buffer buffer;
  buffer.context_ = &context;
  buffer.bytes_ = bytes;
  buffer.name_ = std::move(name);
  buffer.offset_ = offset;
  buffer.borrowed_ = handle;
  return buffer;
}

uint64_t Buffer::bound() const { return allocatedBytes(bytes_); }

vk::BufferView Buffer::texelView() const {
  if (*texels_) return *texels_;
  const uint64_t texels = bound() / (4 * sizeof(float));
  const uint64_t most = context_->limits().maxTexelBufferElements;
  if (texels > most) {
    throw deviceError(fmt::format("\"{}\" has {} texels, {} reaches {} through one view", name_, texels,
                                  context_->report().name, most));
  }
  texels_ = guarded("the texel view of \"" + name_ + "\"", [&] {
    return vk::raii::BufferView(context_->device(),
                                vk::BufferViewCreateInfo{.buffer = handle(),
                                                         .format = vk::Format::eR32G32B32A32Sfloat,
                                                         .offset = offset_,
                                                         .range = bound()});
  });
  context_->name(*texels_, name_);
  return *texels_;
}

HostBuffer::HostBuffer(const Context& context, uint64_t bytes, HostUse use, std::string name)
    : bytes_(bytes), name_(std::move(name)) {
  using Usage = vk::BufferUsageFlagBits;
  using Memory = vk::MemoryPropertyFlagBits;
  checkSize(context, bytes_, name_);
  buffer_ = makeBuffer(context, allocatedBytes(bytes_),
                       Usage::eStorageBuffer | Usage::eUniformBuffer | Usage::eVertexBuffer |
                           Usage::eIndexBuffer | Usage::eTransferSrc | Usage::eTransferDst,
                       name_);
  const auto preferred =
      use == HostUse::readback ? vk::MemoryPropertyFlags(Memory::eHostCached) : vk::MemoryPropertyFlags();
  memory_ = context.allocate(buffer_.getMemoryRequirements(), Memory::eHostVisible | Memory::eHostCoherent,
                             preferred, name_);
  context.name(*memory_, name_);
  guarded(name_, [&] {
    buffer_.bindMemory(*memory_, 0);
    data_ = static_cast<std::byte*>(memory_.mapMemory(0, VK_WHOLE_SIZE));
  });
}

}  // namespace skitter::gpu

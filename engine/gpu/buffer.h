#pragma once

#include "gpu/context.h"

#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace skitter::gpu {

// What a buffer is for beside records: every buffer can be loaded from, stored to and copied both ways.
enum class BufferUse : uint32_t { records = 0, indirect = 1, vertex = 2, index = 4, uniform = 8 };
constexpr BufferUse operator|(BufferUse a, BufferUse b) { return BufferUse(uint32_t(a) | uint32_t(b)); }
constexpr bool has(BufferUse set, BufferUse one) { return (uint32_t(set) & uint32_t(one)) != 0; }

// Device-local memory. A size of 0 is legal: it allocates the least there is, so that an empty herd needs no
// special case. Each buffer is one allocation: buffers are few and large (pages), never per agent.
class Buffer {
 public:
  Buffer() = default;
  // Throws Error(device) when there is not enough memory, saying how much `name` asked for.
  Buffer(const Context&, uint64_t bytes, std::string name, BufferUse = BufferUse::records);
  // `bytes`, a multiple of 16, of a buffer that the caller keeps, from `offset` on, which is aligned as
  // bindings must be. Its usage has STORAGE_BUFFER and, where texel buffers are loaded from,
  // UNIFORM_TEXEL_BUFFER; TRANSFER_SRC and _DST to be copied.
  static Buffer borrowed(const Context&, vk::Buffer, uint64_t bytes, std::string name, uint64_t offset = 0);

  uint64_t size() const { return bytes_; }     // as asked for
  uint64_t offset() const { return offset_; }  // 0, but for borrowed ones
  uint64_t bound() const;                      // bytes that a binding reaches: whole texels
  const std::string& name() const { return name_; }
  vk::Buffer handle() const { return *buffer_ ? *buffer_ : borrowed_; }
  explicit operator bool() const { return !!handle(); }

  // The whole buffer as texels of 4 floats, made at the first call, which is never in the frame loop
  // (Bindings asks for it). Throws Error(device) when the buffer has more texels than a view reaches.
  vk::BufferView texelView() const;

 private:
  const Context* context_ = nullptr;
  uint64_t bytes_ = 0;
  uint64_t offset_ = 0;
  std::string name_;
  vk::raii::DeviceMemory memory_ = nullptr;
  vk::raii::Buffer buffer_ = nullptr;
  vk::Buffer borrowed_;
  mutable vk::raii::BufferView texels_ = nullptr;
};

enum class HostUse {
  upload,    // the host writes, the device reads: staging, per-tick uniforms, vertices of a frame
  readback,  // the device writes, the host reads: cached, or reading crawls
};

// Host-visible memory, mapped and coherent for its whole life.
class HostBuffer {
 public:
  HostBuffer() = default;
  HostBuffer(const Context&, uint64_t bytes, HostUse, std::string name);

  uint64_t size() const { return bytes_; }
  const std::string& name() const { return name_; }
  vk::Buffer handle() const { return *buffer_; }
  explicit operator bool() const { return !!*buffer_; }

  std::span<std::byte> bytes() const { return {data_, size_t(bytes_)}; }
  // The same memory as T; what is left over at the end is out of reach.
  template <class T>
  std::span<T> as() const {
    static_assert(std::is_trivially_copyable_v<T>);
    return {reinterpret_cast<T*>(data_), size_t(bytes_ / sizeof(T))};
  }

 private:
  uint64_t bytes_ = 0;
  std::string name_;
  vk::raii::DeviceMemory memory_ = nullptr;
  vk::raii::Buffer buffer_ = nullptr;
  std::byte* data_ = nullptr;
};

}  // namespace skitter::gpu

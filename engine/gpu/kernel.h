#pragma once

#include "gpu/pipeline.h"

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace skitter::gpu {

// Embedded SPIR-V. A shader built with LOAD_VARIANTS exists twice, and the context picks:
//   ShaderCode{embedded::ik_comp_texel(), embedded::ik_comp_storage()}
struct ShaderCode {
  std::span<const uint8_t> texel;
  std::span<const uint8_t> storage;

  ShaderCode(std::span<const uint8_t> either) : texel(either), storage(either) {}
  ShaderCode(std::span<const uint8_t> texelVariant, std::span<const uint8_t> storageVariant)
      : texel(texelVariant), storage(storageVariant) {}
  std::span<const uint8_t> pick(const Context& context) const {
    return context.texelLoads() ? texel : storage;
  }
};

// A shader module of it; graphics pipelines need it too.
vk::raii::ShaderModule makeModule(const Context&, const ShaderCode&, const std::string& name);

struct SpecConstant {
  uint32_t id;
  uint32_t bits;

  SpecConstant(uint32_t constantId, int32_t value) : id(constantId), bits(uint32_t(value)) {}
  SpecConstant(uint32_t constantId, uint32_t value) : id(constantId), bits(value) {}
  SpecConstant(uint32_t constantId, float value) : id(constantId), bits(std::bit_cast<uint32_t>(value)) {}
  SpecConstant(uint32_t constantId, bool value) : id(constantId), bits(value ? 1u : 0u) {}
};

struct KernelInfo {
  std::string name;
  ShaderCode code;
  std::vector<BindingDecl> bindings = {};
  uint32_t pushBytes = 0;
  std::vector<SpecConstant> constants = {};
};

// The value's bytes, for push constants.
template <class T>
std::span<const std::byte> bytesOf(const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  return std::as_bytes(std::span(&value, 1));
}

// The work groups of `size` invocations that cover `items`.
constexpr uint32_t groupsFor(uint32_t items, uint32_t size) {
  return items / size + (items % size != 0 ? 1u : 0u);
}

// A compute pipeline with its layouts. Making one again is cheap (the context keeps pipelines); making it is
// for set-up, dispatching for the frame loop.
class Kernel {
 public:
  Kernel() = default;
  Kernel(const Context&, const KernelInfo&);

  const std::string& name() const { return layout().name(); }
  const BindingLayout& layout() const { return made_->layout; }
  Bindings bind(const Context& context, std::span<const Binding> list) const {
    return {context, layout(), list};
  }
  Bindings bind(const Context& context, std::initializer_list<Binding> list) const {
    return {context, layout(), list};
  }
  explicit operator bool() const { return !!made_; }

  // `push` is exactly pushBytes long. Zero groups record nothing; more than the device's limit is a caller's
  // bug.
  void dispatch(vk::CommandBuffer, const Bindings&, std::span<const std::byte> push, uint32_t groups) const;
  // The group counts are three uint32 at `offset` in `arguments`, a buffer of BufferUse::indirect.
  void dispatchIndirect(vk::CommandBuffer, const Bindings&, std::span<const std::byte> push,
                        const Buffer& arguments, uint64_t offset = 0) const;

 private:
  void prepare(vk::CommandBuffer, const Bindings&, std::span<const std::byte> push) const;

  std::shared_ptr<const Pipeline> made_;
  uint32_t maxGroups_ = 0;
};

}  // namespace skitter::gpu

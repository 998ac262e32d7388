#pragma once

#include "gpu/buffer.h"
#include "gpu/image.h"

#include <span>
#include <string>
#include <variant>
#include <vector>

namespace skitter::gpu {

enum class BindingKind {
  load4,    // LOAD4_BUFFER: a texel buffer or a storage buffer, as the context says
  store,    // STORE4_BUFFER, or any storage buffer
  uniform,  // a uniform buffer
  heights,  // a sampler2D that is only ever fetched from: nearest, clamped
  texture,  // a sampler2D with the sampler given in the Binding
};

// One line of a shader's interface, always in set 0.
struct BindingDecl {
  uint32_t binding;
  BindingKind kind;
};

// Descriptor set layout and pipeline layout of a kernel or of a graphics pipeline.
class BindingLayout {
 public:
  BindingLayout() = default;
  BindingLayout(const Context&, std::string name, std::vector<BindingDecl>, uint32_t pushBytes,
                vk::ShaderStageFlags = vk::ShaderStageFlagBits::eCompute);

  const std::string& name() const { return name_; }
  std::span<const BindingDecl> declarations() const { return declarations_; }
  uint32_t pushBytes() const { return pushBytes_; }
  vk::ShaderStageFlags stages() const { return stages_; }
  vk::DescriptorSetLayout setLayout() const { return *setLayout_; }
  vk::PipelineLayout pipelineLayout() const { return *pipelineLayout_; }
  vk::DescriptorType descriptorType(BindingKind) const;

 private:
  bool texelLoads_ = false;
  std::string name_;
  std::vector<BindingDecl> declarations_;
  uint32_t pushBytes_ = 0;
  vk::ShaderStageFlags stages_;
  vk::raii::DescriptorSetLayout setLayout_ = nullptr;
  vk::raii::PipelineLayout pipelineLayout_ = nullptr;
};

// What one declared binding is bound to. A load4 takes a Buffer; a store or uniform a Buffer or
// HostBuffer; a heights or texture an Image in state sampled. Everything bound outlives the Bindings.
struct Binding {
  uint32_t binding;
  std::variant<const Buffer*, const HostBuffer*, const Image*> resource;
  vk::Sampler sampler = {};  // for a texture
};

// A descriptor set with concrete resources: made once per page, never in the frame loop. Every declared
// binding is given exactly once (asserted). Throws Error(device) when a buffer is larger than a binding
// reaches.
class Bindings {
 public:
  Bindings() = default;
  Bindings(const Context&, const BindingLayout&, std::span<const Binding>);
  Bindings(const Context& context, const BindingLayout& layout, std::initializer_list<Binding> list)
      : Bindings(context, layout, std::span(list.begin(), list.size())) {}

  vk::DescriptorSet set() const { return set_; }
  explicit operator bool() const { return !!set_; }

 private:
  vk::raii::DescriptorPool pool_ = nullptr;  // of this one set, which goes with it
  vk::DescriptorSet set_;
};

}  // namespace skitter::gpu

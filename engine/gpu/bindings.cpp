#include "gpu/bindings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace skitter::gpu {
namespace {

bool isTexel(vk::DescriptorType type) { return type == vk::DescriptorType::eUniformTexelBuffer; }
bool isImage(vk::DescriptorType type) { return type == vk::DescriptorType::eCombinedImageSampler; }

void checkReach(const Context& context, uint64_t bytes, const std::string& buffer,
                const std::string& layout) {
  if (bytes <= context.limits().maxStorageBufferRange) return;
  throw deviceError(
      fmt::format("\"{}\" ({:.1f} MiB) is too large for \"{}\": {} reaches {:.1f} MiB of a storage buffer",
                  buffer, double(bytes) / (1 << 20), layout, context.report().name,
                  double(context.limits().maxStorageBufferRange) / (1 << 20)));
}

// What a descriptor write points to; one of the three is used.
struct Target {
  vk::DescriptorBufferInfo buffer;
  vk::DescriptorImageInfo image;
  vk::BufferView view;
};

Target targetOf(const Context& context, const BindingLayout& layout, const BindingDecl& decl,
                const Binding& binding) {
  const vk::DescriptorType type = layout.descriptorType(decl.kind);
  Target target;
  if (isImage(type)) {
    assert(std::holds_alternative<const Image*>(binding.resource));
    assert(decl.kind == BindingKind::heights || binding.sampler);
    const Image& image = *std::get<const Image*>(binding.resource);
    target.image = {.sampler = decl.kind == BindingKind::heights ? context.nearestSampler() : binding.sampler,
                    .imageView = image.view(),
                    .imageLayout = vk::ImageLayout::eShaderReadOnlyOptimal};
  } else if (isTexel(type)) {
    assert(std::holds_alternative<const Buffer*>(binding.resource));
    target.view = std::get<const Buffer*>(binding.resource)->texelView();
  } else if (const auto* host = std::get_if<const HostBuffer*>(&binding.resource)) {
    assert(decl.kind != BindingKind::load4);
    if (type == vk::DescriptorType::eStorageBuffer)
      checkReach(context, (*host)->size(), (*host)->name(), layout.name());
    target.buffer = vk::DescriptorBufferInfo{.buffer = (*host)->handle(), .range = VK_WHOLE_SIZE};
  } else {
    assert(std::holds_alternative<const Buffer*>(binding.resource));
    const Buffer& buffer = *std::get<const Buffer*>(binding.resource);
    if (type == vk::DescriptorType::eStorageBuffer)
      checkReach(context, buffer.size(), buffer.name(), layout.name());
    target.buffer = vk::DescriptorBufferInfo{
        .buffer = buffer.handle(), .offset = buffer.offset(), .range = buffer.bound()};
  }
  return target;
}

}  // namespace

BindingLayout::BindingLayout(const Context& context, std::string name, std::vector<BindingDecl> declarations,
                             uint32_t pushBytes, vk::ShaderStageFlags stages)
    : texelLoads_(context.texelLoads()),
      name_(std::move(name)),
      declarations_(std::move(declarations)),
      pushBytes_(pushBytes),
      stages_(stages) {
  assert(pushBytes % 4 == 0 && pushBytes <= context.limits().maxPushConstantsSize);
  std::vector<vk::DescriptorSetLayoutBinding> slots;
  for (const BindingDecl& decl : declarations_) {
    slots.push_back({.binding = decl.binding,
                     .descriptorType = descriptorType(decl.kind),
                     .descriptorCount = 1,
                     .stageFlags = stages_});
  }
  guarded("the layout of \"" + name_ + "\"", [&] {
    setLayout_ = vk::raii::DescriptorSetLayout(
        context.device(),
        vk::DescriptorSetLayoutCreateInfo{.bindingCount = uint32_t(slots.size()), .pBindings = slots.data()});
    const vk::PushConstantRange push{.stageFlags = stages_, .offset = 0, .size = pushBytes_};
    pipelineLayout_ = vk::raii::PipelineLayout(
        context.device(), vk::PipelineLayoutCreateInfo{.setLayoutCount = 1,
                                                       .pSetLayouts = &*setLayout_,
                                                       .pushConstantRangeCount = pushBytes_ > 0 ? 1u : 0u,
                                                       .pPushConstantRanges = &push});
  });
  context.name(*setLayout_, name_);
  context.name(*pipelineLayout_, name_);
}

vk::DescriptorType BindingLayout::descriptorType(BindingKind kind) const {
  switch (kind) {
    case BindingKind::load4:
      return texelLoads_ ? vk::DescriptorType::eUniformTexelBuffer : vk::DescriptorType::eStorageBuffer;
    case BindingKind::store:
      return vk::DescriptorType::eStorageBuffer;
    case BindingKind::uniform:
      return vk::DescriptorType::eUniformBuffer;
    case BindingKind::heights:
    case BindingKind::texture:
      return vk::DescriptorType::eCombinedImageSampler;
  }
  return vk::DescriptorType::eStorageBuffer;
}

Bindings::Bindings(const Context& context, const BindingLayout& layout, std::span<const Binding> list) {
  const auto declarations = layout.declarations();
  assert(list.size() == declarations.size());
  std::vector<Target> targets(list.size());
  std::vector<vk::DescriptorPoolSize> sizes;
  std::vector<vk::WriteDescriptorSet> writes;
  for (size_t i = 0; i < declarations.size(); ++i) {
    const BindingDecl& decl = declarations[i];
    const auto found = std::find_if(list.begin(), list.end(),
                                    [&](const Binding& binding) { return binding.binding == decl.binding; });
    assert(found != list.end());
    targets[i] = targetOf(context, layout, decl, *found);
    const vk::DescriptorType type = layout.descriptorType(decl.kind);
    sizes.push_back({.type = type, .descriptorCount = 1});
    writes.push_back({.dstBinding = decl.binding,
                      .descriptorCount = 1,
                      .descriptorType = type,
                      .pImageInfo = isImage(type) ? &targets[i].image : nullptr,
                      .pBufferInfo = isImage(type) || isTexel(type) ? nullptr : &targets[i].buffer,
                      .pTexelBufferView = isTexel(type) ? &targets[i].view : nullptr});
  }
  guarded("the bindings of \"" + layout.name() + "\"", [&] {
    pool_ = vk::raii::DescriptorPool(
        context.device(),
        vk::DescriptorPoolCreateInfo{
            .maxSets = 1, .poolSizeCount = uint32_t(sizes.size()), .pPoolSizes = sizes.data()});
    const auto setLayout = layout.setLayout();
    set_ = (*context.device())
               .allocateDescriptorSets(
                   {.descriptorPool = *pool_, .descriptorSetCount = 1, .pSetLayouts = &setLayout})
               .front();
  });
  for (vk::WriteDescriptorSet& write : writes) write.dstSet = set_;
  (*context.device()).updateDescriptorSets(writes, {});
  context.name(set_, layout.name());
}

}  // namespace skitter::gpu

#include "gpu/kernel.h"

#include "shared/load4.h"

#include <cassert>

namespace skitter::gpu {

vk::raii::ShaderModule makeModule(const Context& context, const ShaderCode& code, const std::string& name) {
  const std::span<const uint8_t> bytes = code.pick(context);
  assert(bytes.size() >= 20 && bytes.size() % 4 == 0 && uintptr_t(bytes.data()) % 4 == 0);
  auto module = guarded("the shader \"" + name + "\"", [&] {
    return vk::raii::ShaderModule(
        context.device(),
        vk::ShaderModuleCreateInfo{.codeSize = bytes.size(),
                                   .pCode = reinterpret_cast<const uint32_t*>(bytes.data())});
  });
  context.name(*module, name);
  return module;
}

namespace {

Pipeline makePipeline(const Context& context, const KernelInfo& info) {
  Pipeline made{BindingLayout(context, info.name, info.bindings, info.pushBytes)};
  const auto module = makeModule(context, info.code, info.name);
  std::vector<vk::SpecializationMapEntry> entries;
  std::vector<uint32_t> values;
  const auto specialize = [&](const SpecConstant& constant) {
    entries.push_back({.constantID = constant.id,
                       .offset = uint32_t(values.size() * sizeof(uint32_t)),
                       .size = sizeof(uint32_t)});
    values.push_back(constant.bits);
  };
  for (const SpecConstant& constant : info.constants) specialize(constant);
  specialize({shared::CONSTANT_WIDE_STORES, context.wideStores()});
  const vk::SpecializationInfo specialization{.mapEntryCount = uint32_t(entries.size()),
                                              .pMapEntries = entries.data(),
                                              .dataSize = values.size() * sizeof(uint32_t),
                                              .pData = values.data()};
  made.handle = guarded("the kernel \"" + info.name + "\"", [&] {
    return vk::raii::Pipeline(
        context.device(), context.pipelineCache(),
        vk::ComputePipelineCreateInfo{.stage = {.stage = vk::ShaderStageFlagBits::eCompute,
                                                .module = *module,
                                                .pName = "main",
                                                .pSpecializationInfo = &specialization},
                                      .layout = made.layout.pipelineLayout()});
  });
  context.name(*made.handle, info.name);
  return made;
}

}  // namespace

Kernel::Kernel(const Context& context, const KernelInfo& info)
    : made_(context.pipelines().of(PipelineKey()
                                       .add(info.name)
                                       .add(context, info.code)
                                       .add(info.bindings)
                                       .add(info.pushBytes)
                                       .add(info.constants),
                                   [&] { return makePipeline(context, info); })),
      maxGroups_(context.limits().maxComputeWorkGroupCountX) {}

void Kernel::prepare(vk::CommandBuffer cmd, const Bindings& bindings, std::span<const std::byte> push) const {
  assert(made_ && bindings);
  assert(push.size() == layout().pushBytes());
  cmd.bindPipeline(vk::PipelineBindPoint::eCompute, *made_->handle);
  cmd.bindDescriptorSets(vk::PipelineBindPoint::eCompute, layout().pipelineLayout(), 0, bindings.set(), {});
  if (!push.empty()) {
    cmd.pushConstants(layout().pipelineLayout(), layout().stages(), 0, uint32_t(push.size()), push.data());
  }
}

void Kernel::dispatch(vk::CommandBuffer cmd, const Bindings& bindings, std::span<const std::byte> push,
                      uint32_t groups) const {
  assert(groups <= maxGroups_);
  if (groups == 0) return;
  prepare(cmd, bindings, push);
  cmd.dispatch(groups, 1, 1);
}

void Kernel::dispatchIndirect(vk::CommandBuffer cmd, const Bindings& bindings,
                              std::span<const std::byte> push, const Buffer& arguments,
                              uint64_t offset) const {
  assert(offset % 4 == 0 && offset + 3 * sizeof(uint32_t) <= arguments.size());
  prepare(cmd, bindings, push);
  cmd.dispatchIndirect(arguments.handle(), offset);
}

}  // namespace skitter::gpu

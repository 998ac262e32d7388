#include "gpu/context.h"

#include "gpu/adopt.h"
#include "gpu/device_memory.h"
#include "gpu/pipeline.h"
#include "gpu/spares.h"

#include <fmt/format.h>

namespace skitter::gpu {
namespace {

// Bytes. To ask the system for its free memory takes as long as many downloads of a small buffer.
constexpr uint64_t kLeastChecked = 1 << 20;

std::string mebibytes(uint64_t bytes) { return fmt::format("{:.1f} MiB", double(bytes) / (1 << 20)); }

}  // namespace

Context::Context(Parts parts)
    : parts_(std::move(parts)),
      pipelines_(std::make_unique<Pipelines>()),
      spares_(std::make_unique<Spares>()) {
  guarded("device set-up", [&] {
    const std::vector<uint8_t> cached = std::exchange(parts_.pipelineCache, {});
    pipelineCache_ =
        parts_.hostsCache
            ? adoptPipelineCache(device(), parts_.hostsCache)
            : vk::raii::PipelineCache(device(), vk::PipelineCacheCreateInfo{.initialDataSize = cached.size(),
                                                                            .pInitialData = cached.data()});
    nearestSampler_ = vk::raii::Sampler(
        device(), vk::SamplerCreateInfo{.magFilter = vk::Filter::eNearest,
                                        .minFilter = vk::Filter::eNearest,
                                        .mipmapMode = vk::SamplerMipmapMode::eNearest,
                                        .addressModeU = vk::SamplerAddressMode::eClampToEdge,
                                        .addressModeV = vk::SamplerAddressMode::eClampToEdge,
                                        .addressModeW = vk::SamplerAddressMode::eClampToEdge});
  });
  name(*nearestSampler_, "nearest sampler");
}

Context::~Context() = default;

vk::raii::DeviceMemory Context::allocate(const vk::MemoryRequirements& requirements,
                                         vk::MemoryPropertyFlags wanted, vk::MemoryPropertyFlags preferred,
                                         const std::string& what) const {
  const auto memory = physical().getMemoryProperties();
  auto type = memoryTypeOf(memory, requirements.memoryTypeBits, wanted | preferred);
  if (!type) type = memoryTypeOf(memory, requirements.memoryTypeBits, wanted);
  if (!type) {
    throw deviceError(fmt::format("\"{}\" needs {} of {} memory, which {} does not have", what,
                                  mebibytes(requirements.size), vk::to_string(wanted), report().name));
  }
  const auto refuse = [&](const std::string& reason) {
    return deviceError(
        fmt::format("out of device memory: \"{}\" needs {}, {}", what, mebibytes(requirements.size), reason));
  };
  const uint64_t heap = memory.memoryHeaps[memory.memoryTypes[*type].heapIndex].size;
  if (requirements.size > heap) throw refuse(fmt::format("the heap has {}", mebibytes(heap)));
  if (isCpu() && requirements.size >= kLeastChecked) {
    // A software driver takes what it is asked for, and the system kills us for it later.
    const FreeMemory available = availableMemory(physical());
    if (requirements.size > available.bytes)
      throw refuse(fmt::format("{} are free ({})", mebibytes(available.bytes), available.of));
  }
  try {
    return {device(), vk::MemoryAllocateInfo{.allocationSize = requirements.size, .memoryTypeIndex = *type}};
  } catch (const vk::SystemError& failure) {
    throw refuse(failure.what());
  }
}

void Context::setName(vk::ObjectType type, uint64_t handle, const std::string& text) const {
  const auto set = device().getDispatcher()->vkSetDebugUtilsObjectNameEXT;
  if (!parts_.debugUtils || !set) return;
  const VkDebugUtilsObjectNameInfoEXT info{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                           .pNext = nullptr,
                                           .objectType = VkObjectType(type),
                                           .objectHandle = handle,
                                           .pObjectName = text.c_str()};
  set(*device(), &info);
}

void Context::beginLabel(vk::CommandBuffer cmd, const char* text) const {
  const auto begin = device().getDispatcher()->vkCmdBeginDebugUtilsLabelEXT;
  if (!parts_.debugUtils || !begin) return;
  const VkDebugUtilsLabelEXT label{
      .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, .pNext = nullptr, .pLabelName = text, .color = {}};
  begin(cmd, &label);
}

void Context::endLabel(vk::CommandBuffer cmd) const {
  const auto end = device().getDispatcher()->vkCmdEndDebugUtilsLabelEXT;
  if (parts_.debugUtils && end) end(cmd);
}

void Context::waitIdle() const {
  guarded("waiting for the device", [&] {
    if (!parts_.adopted) return device().waitIdle();
    // Other queues of it are the host's, who may be using them.
    const vk::raii::Fence done(device(), vk::FenceCreateInfo{});
    queue()->submit2({}, *done);
    const vk::Result result = device().waitForFences(*done, true, UINT64_MAX);
    if (result != vk::Result::eSuccess) throw deviceError("waiting for the device: " + vk::to_string(result));
  });
}

}  // namespace skitter::gpu

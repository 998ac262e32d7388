#include "gpu/device_memory.h"

#include "gpu/extensions.h"

#include <algorithm>

namespace skitter::gpu {

std::optional<uint32_t> memoryTypeOf(const vk::PhysicalDeviceMemoryProperties& memory, uint32_t allowed,
                                     vk::MemoryPropertyFlags flags) {
  for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
    if ((allowed >> i & 1u) && (memory.memoryTypes[i].propertyFlags & flags) == flags) return i;
  }
  return {};
}

uint64_t largestDeviceHeap(const vk::PhysicalDeviceMemoryProperties& memory) {
  uint64_t bytes = 0;
  for (uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
    if (memory.memoryHeaps[i].flags & vk::MemoryHeapFlagBits::eDeviceLocal) {
      bytes = std::max<uint64_t>(bytes, memory.memoryHeaps[i].size);
    }
  }
  return bytes;
}

FreeMemory availableMemory(const vk::raii::PhysicalDevice& physical) {
  const auto memory = physical.getMemoryProperties();
  if (physical.getProperties().deviceType == vk::PhysicalDeviceType::eCpu) {
    if (auto ram = freeMemory()) return std::move(*ram);
  } else if (hasExtension(physical, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME)) {
    const auto chain = physical.getMemoryProperties2<vk::PhysicalDeviceMemoryProperties2,
                                                     vk::PhysicalDeviceMemoryBudgetPropertiesEXT>();
    const auto& budget = chain.get<vk::PhysicalDeviceMemoryBudgetPropertiesEXT>();
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
      if (!(memory.memoryHeaps[i].flags & vk::MemoryHeapFlagBits::eDeviceLocal)) continue;
      if (budget.heapBudget[i] > budget.heapUsage[i]) {
        bytes = std::max<uint64_t>(bytes, budget.heapBudget[i] - budget.heapUsage[i]);
      }
    }
    return {.bytes = bytes, .of = "driver's budget"};
  }
  return {.bytes = largestDeviceHeap(memory), .of = "largest heap"};
}

}  // namespace skitter::gpu

#pragma once

#include "gpu/free_memory.h"
#include "gpu/vulkan.h"

namespace skitter::gpu {

// Bytes of the largest heap that is the device's own (DeviceLimits::heapBytes).
uint64_t largestDeviceHeap(const vk::PhysicalDeviceMemoryProperties&);

// Memory that can be allocated on it now (DeviceLimits::availableBytes and availableOf).
FreeMemory availableMemory(const vk::raii::PhysicalDevice&);

}  // namespace skitter::gpu

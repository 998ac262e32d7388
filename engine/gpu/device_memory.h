#pragma once

#include <optional>

#include "gpu/free_memory.h"
#include "gpu/vulkan.h"

namespace skitter::gpu {

// The first of the `allowed` types (a bit each) that has all of these flags.
std::optional<uint32_t> memoryTypeOf(const vk::PhysicalDeviceMemoryProperties&, uint32_t allowed,
                                     vk::MemoryPropertyFlags);

// Bytes of the largest heap that is the device's own (DeviceLimits::heapBytes).
uint64_t largestDeviceHeap(const vk::PhysicalDeviceMemoryProperties&);

// Memory that can be allocated on it now (DeviceLimits::availableBytes and availableOf).
FreeMemory availableMemory(const vk::raii::PhysicalDevice&);

}  // namespace skitter::gpu

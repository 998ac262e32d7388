#pragma once

#include "gpu/vulkan.h"

namespace skitter::gpu {

// The caller's handles as vk::raii objects that never destroy them.
vk::raii::Instance adoptInstance(const vk::raii::Context&, VkInstance);
vk::raii::Device adoptDevice(const vk::raii::PhysicalDevice&, VkDevice);
// The place of a device in Vulkan's order; nothing where the instance does not have it.
std::optional<uint32_t> indexOf(const vk::raii::Instance&, VkPhysicalDevice);
// After it, no pipeline cache of the device is ever destroyed.
vk::raii::PipelineCache adoptPipelineCache(const vk::raii::Device&, VkPipelineCache);

}  // namespace skitter::gpu

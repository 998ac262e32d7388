#pragma once

#include "gpu/vulkan.h"

namespace skitter::gpu {

// The caller's handles as vk::raii objects that never destroy them.
vk::raii::Instance adoptInstance(const vk::raii::Context&, VkInstance);
vk::raii::Device adoptDevice(const vk::raii::PhysicalDevice&, VkDevice);

}  // namespace skitter::gpu

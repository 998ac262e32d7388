#pragma once

#include "gpu/vulkan.h"

namespace skitter::gpu {

bool hasExtension(const vk::raii::PhysicalDevice&, const char* name);

}  // namespace skitter::gpu

#include "gpu/extensions.h"

#include <algorithm>
#include <cstring>

namespace skitter::gpu {

bool hasExtension(const vk::raii::PhysicalDevice& physical, const char* name) {
  const auto list = physical.enumerateDeviceExtensionProperties();
  return std::any_of(list.begin(), list.end(), [&](const auto& extension) {
    return std::strcmp(extension.extensionName.data(), name) == 0;
  });
}

}  // namespace skitter::gpu

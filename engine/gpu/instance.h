#pragma once

#include "gpu/vulkan.h"
#include "skitter/device.h"

#include <memory>

namespace skitter::gpu {

struct Instance {
  std::shared_ptr<ValidationLog> log;  // first, so that it hears the others go
  vk::raii::Context loader;
  vk::raii::Instance instance = nullptr;
  vk::raii::DebugUtilsMessengerEXT messenger = nullptr;
  bool debugUtils = false;
};

// With what the request asks for: validation into `log`, the window system's extensions. Throws Error(device)
// when there is no Vulkan driver, no validation layer, or an extension is missing.
Instance makeInstance(const DeviceRequest&);

}  // namespace skitter::gpu

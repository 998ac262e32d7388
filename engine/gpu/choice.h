#pragma once

#include "gpu/device_memory.h"
#include "gpu/vulkan.h"
#include "skitter/device.h"

#include <vector>

namespace skitter::gpu {

struct Candidate {
  vk::raii::PhysicalDevice physical;
  DeviceReport report;
  uint32_t queueFamily = 0;
};

// Reports on a device and what speaks against it; the queue family is the best one. Of an adopted device,
// what its maker says of it decides.
Candidate inspect(vk::raii::PhysicalDevice, uint32_t index, const DeviceRequest&,
                  const AdoptedDevice* adopted = nullptr);

// Every device, in Vulkan's order, with the request's choice marked if there is one.
std::vector<Candidate> candidates(const vk::raii::Instance&, const DeviceRequest&);

// The one marked. Throws Error(device) listing all and their reasons when there is none.
Candidate& chosen(std::vector<Candidate>&, const DeviceRequest&);

}  // namespace skitter::gpu

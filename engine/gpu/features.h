#pragma once

#include <array>
#include <cstddef>

#include "gpu/vulkan.h"
#include "skitter/device.h"

namespace skitter::gpu {

// A feature of Vulkan that the engine uses. It is a VkBool32 of a structure in the chain that vkCreateDevice
// is given: of the structure that Vulkan 1.1, 1.2 or 1.3 has for all of its features, or of the one with
// which it began.
struct Feature {
  enum class Need {
    required,
    recommended,  // the engine is quicker with it
    unused,       // switched on and reported on devices of ours, for who draws there
  };
  const char* name;
  Need need;
  bool DeviceFeatures::*reported;  // nullptr for those required
  struct Place {
    VkStructureType structure = VK_STRUCTURE_TYPE_MAX_ENUM;
    size_t offset = 0;
  } place, alone = {};

  bool isRequired() const { return need == Need::required; }
  // Null where the chain has no structure for it.
  VkBool32* in(VkPhysicalDeviceFeatures2& chain) const;
  bool isOnIn(const VkPhysicalDeviceFeatures2& chain) const;
};

// Every one: a row here is all that requests, reports and refusals need.
extern const std::array<Feature, 11> allFeatures;

// A chain with a place for each. It points into itself.
struct FeatureChain {
  VkPhysicalDeviceFeatures2 core{};
  VkPhysicalDeviceVulkan11Features v11{};
  VkPhysicalDeviceVulkan12Features v12{};
  VkPhysicalDeviceVulkan13Features v13{};

  FeatureChain();
  FeatureChain(const FeatureChain&) = delete;
  FeatureChain& operator=(const FeatureChain&) = delete;
};

}  // namespace skitter::gpu

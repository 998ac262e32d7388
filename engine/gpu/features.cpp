#include "gpu/features.h"

#include <fmt/format.h>

#include "skitter/error.h"

namespace skitter {
namespace gpu {
namespace {

constexpr Feature::Place core(size_t offset) {
  return {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
          offsetof(VkPhysicalDeviceFeatures2, features) + offset};
}

#define SKITTER_IN(name, TYPE, Structure)                     \
  {                                                           \
    VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_##TYPE##_FEATURES,      \
        offsetof(VkPhysicalDevice##Structure##Features, name) \
  }
#define SKITTER_CORE(name) core(offsetof(VkPhysicalDeviceFeatures, name))
#define SKITTER_REQUIRED(name) #name, Feature::Need::required, nullptr
#define SKITTER_OPTIONAL(name, need) #name, Feature::Need::need, &DeviceFeatures::name

}  // namespace

const std::array<Feature, 11> allFeatures = {
    Feature{SKITTER_REQUIRED(dynamicRendering), SKITTER_IN(dynamicRendering, VULKAN_1_3, Vulkan13),
            SKITTER_IN(dynamicRendering, DYNAMIC_RENDERING, DynamicRendering)},
    Feature{SKITTER_REQUIRED(synchronization2), SKITTER_IN(synchronization2, VULKAN_1_3, Vulkan13),
            SKITTER_IN(synchronization2, SYNCHRONIZATION_2, Synchronization2)},
    // Work groups have their size as SPIR-V 1.6 states it.
    Feature{SKITTER_REQUIRED(maintenance4), SKITTER_IN(maintenance4, VULKAN_1_3, Vulkan13),
            SKITTER_IN(maintenance4, MAINTENANCE_4, Maintenance4)},
    Feature{SKITTER_REQUIRED(timelineSemaphore), SKITTER_IN(timelineSemaphore, VULKAN_1_2, Vulkan12),
            SKITTER_IN(timelineSemaphore, TIMELINE_SEMAPHORE, TimelineSemaphore)},
    Feature{SKITTER_OPTIONAL(drawIndirectCount, unused), SKITTER_IN(drawIndirectCount, VULKAN_1_2, Vulkan12)},
    Feature{SKITTER_OPTIONAL(multiDrawIndirect, unused), SKITTER_CORE(multiDrawIndirect)},
    Feature{SKITTER_OPTIONAL(drawIndirectFirstInstance, unused), SKITTER_CORE(drawIndirectFirstInstance)},
    Feature{SKITTER_OPTIONAL(shaderDrawParameters, unused),
            SKITTER_IN(shaderDrawParameters, VULKAN_1_1, Vulkan11),
            SKITTER_IN(shaderDrawParameters, SHADER_DRAW_PARAMETERS, ShaderDrawParameters)},
    Feature{SKITTER_OPTIONAL(fillModeNonSolid, unused), SKITTER_CORE(fillModeNonSolid)},
    Feature{SKITTER_OPTIONAL(samplerAnisotropy, unused), SKITTER_CORE(samplerAnisotropy)},
    Feature{SKITTER_OPTIONAL(shaderInt64, recommended), SKITTER_CORE(shaderInt64)},
};

VkBool32* Feature::in(VkPhysicalDeviceFeatures2& chain) const {
  for (auto* next = reinterpret_cast<VkBaseOutStructure*>(&chain); next != nullptr; next = next->pNext)
    for (const Place& each : {place, alone})
      if (next->sType == each.structure)
        return reinterpret_cast<VkBool32*>(reinterpret_cast<std::byte*>(next) + each.offset);
  return nullptr;
}

bool Feature::isOnIn(const VkPhysicalDeviceFeatures2& chain) const {
  const VkBool32* const on = in(const_cast<VkPhysicalDeviceFeatures2&>(chain));
  return on != nullptr && *on == VK_TRUE;
}

FeatureChain::FeatureChain() {
  core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  v11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
  v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  core.pNext = &v11;
  v11.pNext = &v12;
  v12.pNext = &v13;
}

namespace {

struct Wanted : FeatureChain {
  explicit Wanted(Feature::Need need) {
    for (const Feature& feature : allFeatures) *feature.in(core) = feature.need == need;
  }
};

}  // namespace
}  // namespace gpu

const VkPhysicalDeviceFeatures2& requiredFeatures() {
  static const gpu::Wanted wanted(gpu::Feature::Need::required);
  return wanted.core;
}

const VkPhysicalDeviceFeatures2& recommendedFeatures() {
  static const gpu::Wanted wanted(gpu::Feature::Need::recommended);
  return wanted.core;
}

std::span<const char* const> requiredExtensions() { return {}; }

std::span<const char* const> recommendedExtensions() {
  static constexpr std::array names = {VK_EXT_MEMORY_BUDGET_EXTENSION_NAME};
  return names;
}

void addFeatures(VkPhysicalDeviceFeatures2& features, VkPhysicalDevice physicalDevice) {
  gpu::FeatureChain has;
  vkGetPhysicalDeviceFeatures2(physicalDevice, &has.core);
  for (const gpu::Feature& feature : gpu::allFeatures) {
    VkBool32* const on = feature.in(features);
    if (on == nullptr && feature.isRequired())
      throw inputError(
          fmt::format("the chain of features has no structure with {}, expected "
                      "VkPhysicalDeviceVulkan12Features and VkPhysicalDeviceVulkan13Features",
                      feature.name));
    const bool wanted = feature.need == gpu::Feature::Need::recommended && feature.isOnIn(has.core);
    if (on != nullptr && (feature.isRequired() || wanted)) *on = VK_TRUE;
  }
}

}  // namespace skitter

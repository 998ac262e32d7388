#include "gpu/adopt.h"

// Vulkan-Hpp has no way to let go of a handle, but each object destroys through a function table of its own,
// which lives on the heap and is not const itself.
namespace skitter::gpu {

vk::raii::Instance adoptInstance(const vk::raii::Context& loader, VkInstance handle) {
  vk::raii::Instance instance(loader, handle);
  const_cast<vk::raii::InstanceDispatcher*>(instance.getDispatcher())->vkDestroyInstance =
      [](VkInstance, const VkAllocationCallbacks*) {};
  return instance;
}

vk::raii::Device adoptDevice(const vk::raii::PhysicalDevice& physical, VkDevice handle) {
  vk::raii::Device device(physical, handle);
  const_cast<vk::raii::DeviceDispatcher*>(device.getDispatcher())->vkDestroyDevice =
      [](VkDevice, const VkAllocationCallbacks*) {};
  return device;
}

std::optional<uint32_t> indexOf(const vk::raii::Instance& instance, VkPhysicalDevice wanted) {
  uint32_t index = 0;
  for (const vk::raii::PhysicalDevice& physical : vk::raii::PhysicalDevices(instance)) {
    if (*physical == vk::PhysicalDevice(wanted)) return index;
    ++index;
  }
  return {};
}

vk::raii::PipelineCache adoptPipelineCache(const vk::raii::Device& device, VkPipelineCache handle) {
  const_cast<vk::raii::DeviceDispatcher*>(device.getDispatcher())->vkDestroyPipelineCache =
      [](VkDevice, VkPipelineCache, const VkAllocationCallbacks*) {};
  return {device, handle};
}

}  // namespace skitter::gpu

#include "gpu/transfer.h"
#include "support/gpu_fixture.h"

#include <gmock/gmock.h>

namespace skitter {
namespace {

// An application's own device, by plain Vulkan calls.
class Own {
 public:
  Own() {
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo instanceInfo{};
    instanceInfo.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    instanceInfo.pApplicationInfo = &application;
    EXPECT_EQ(vkCreateInstance(&instanceInfo, nullptr, &instance), VK_SUCCESS);

    const uint32_t index = Device::create(test::validatedRequest()).report().index;
    std::vector<VkPhysicalDevice> all(index + 1);
    uint32_t count = index + 1;
    vkEnumeratePhysicalDevices(instance, &count, all.data());
    physical = all.at(index);

    const float priority = 1;
    VkDeviceQueueCreateInfo queueInfo{};
    queueInfo.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    VkPhysicalDeviceVulkan13Features v13{};
    v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    v13.synchronization2 = v13.dynamicRendering = VK_TRUE;
    VkPhysicalDeviceVulkan12Features v12{};
    v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    v12.pNext = &v13;
    v12.timelineSemaphore = VK_TRUE;
    VkDeviceCreateInfo deviceInfo{};
    deviceInfo.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    deviceInfo.pNext = &v12;
    deviceInfo.queueCreateInfoCount = 1;
    deviceInfo.pQueueCreateInfos = &queueInfo;
    EXPECT_EQ(vkCreateDevice(physical, &deviceInfo, nullptr, &device), VK_SUCCESS);
    vkGetDeviceQueue(device, 0, 0, &queue);
  }
  ~Own() {
    vkDestroyDevice(device, nullptr);
    vkDestroyInstance(instance, nullptr);
  }
  Own(const Own&) = delete;
  Own& operator=(const Own&) = delete;

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
};

TEST(Adopt, WorksOnTheCallersDeviceAndLeavesIt) {
  const Own own;
  for (int round = 0; round < 2; ++round) {
    Device device =
        Device::adopt(own.instance, own.physical, own.device, 0, own.queue, vkGetInstanceProcAddr);
    EXPECT_EQ(device.handle(), own.device);
    EXPECT_EQ(device.queue(), own.queue);
    EXPECT_TRUE(device.report().suitable);
    EXPECT_NE(device.report().loads.why, "");
    Device moved = std::move(device);
    const std::vector<uint32_t> data{1, 2, 3};
    const gpu::Buffer buffer(moved.context(), 12, "adopted");
    gpu::upload(moved.context(), buffer, data);
    EXPECT_EQ(gpu::download<uint32_t>(moved.context(), buffer), data);
  }
  EXPECT_EQ(vkDeviceWaitIdle(own.device), VK_SUCCESS);
}

TEST(Adopt, RefusesAQueueFamilyThatIsNotThere) {
  const Own own;
  try {
    Device::adopt(own.instance, own.physical, own.device, 99, own.queue, vkGetInstanceProcAddr);
    FAIL() << "it was adopted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::device);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("99"));
  }
  EXPECT_EQ(vkDeviceWaitIdle(own.device), VK_SUCCESS);
}

}  // namespace
}  // namespace skitter

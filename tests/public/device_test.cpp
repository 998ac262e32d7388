#include "skitter/device.h"

#include <string>
#include <utility>

#include "public/public.h"

namespace skitter::test {
namespace {

using PublicDevice = PublicTest;

// The first structure of that type in a chain.
template <class Structure>
const Structure* structureIn(const VkPhysicalDeviceFeatures2& chain, VkStructureType type) {
  for (auto* next = static_cast<const VkBaseInStructure*>(chain.pNext); next != nullptr; next = next->pNext)
    if (next->sType == type) return reinterpret_cast<const Structure*>(next);
  return nullptr;
}

TEST_F(PublicDevice, IsTheOneThatListDevicesChooses) {
  uint32_t chosen = 0;
  for (const DeviceReport& report : listDevices(publicRequest())) {
    EXPECT_NE(std::string(report.typeName()), "");
    EXPECT_EQ(report.suitable, report.refusals.empty()) << report.name;
    if (!report.chosen) {
      EXPECT_NE(report.whyNot, "") << report.name;
      continue;
    }
    ++chosen;
    EXPECT_EQ(report.name, device().report().name);
    EXPECT_EQ(report.index, device().report().index);
  }
  EXPECT_EQ(chosen, 1u);
  EXPECT_TRUE(device().report().suitable);
}

TEST_F(PublicDevice, TypesHaveNames) {
  DeviceReport report;
  report.type = VK_PHYSICAL_DEVICE_TYPE_CPU;
  EXPECT_STREQ(report.typeName(), "cpu");
  report.type = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
  EXPECT_STREQ(report.typeName(), "discrete");
}

TEST_F(PublicDevice, RunsCommandsAndWaits) {
  const OwnBuffer buffer(device(), 64);
  device().run([&](VkCommandBuffer commands) {
    vkCmdFillBuffer(commands, buffer.handle(), 0, 64, 0x3f800000);
    OwnBuffer::toHost(commands);
  });
  for (int i = 0; i < 16; ++i) EXPECT_EQ(buffer.floats()[i], 1.0f) << i;
  EXPECT_NO_THROW(device().waitIdle());
  expectRefused("Device::run was given no function", [&] { device().run({}); });
}

TEST_F(PublicDevice, HandsItsHandlesOutAndKeepsThemWhenMoved) {
  Device first = Device::create(publicRequest());
  const VkDevice handle = first.handle();
  const auto* const context = &first.context();
  Device second = std::move(first);
  EXPECT_EQ(second.handle(), handle);
  EXPECT_EQ(&second.context(), context);
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(second.physicalDevice(), &properties);
  EXPECT_EQ(properties.deviceName, second.report().name);
  VkQueue queue = VK_NULL_HANDLE;
  vkGetDeviceQueue(second.handle(), second.queueFamily(), 0, &queue);
  EXPECT_EQ(second.queue(), queue);
  EXPECT_NE(second.instance(), VkInstance{VK_NULL_HANDLE});
  second = Device::create(publicRequest());
  EXPECT_NE(second.queue(), VkQueue{VK_NULL_HANDLE});
}

TEST_F(PublicDevice, PipelinesGoIntoTheNextDevice) {
  DeviceRequest request = publicRequest();
  request.pipelineCache = device().pipelineCacheData();
  EXPECT_FALSE(request.pipelineCache.empty());
  EXPECT_GE(Device::create(request).pipelineCacheData().size(), request.pipelineCache.size());
}

TEST_F(PublicDevice, RefusesADeviceThatIsNotThere) {
  DeviceRequest request = publicRequest();
  request.device = "no such device";
  expectError(Error::Kind::device, "no such device", [&] { Device::create(request); });
}

TEST_F(PublicDevice, CollectsMessages) {
  EXPECT_TRUE(device().validationMessages().empty());
  ValidationLog log;
  log.add("VUID-a", "wrong");
  log.add("VUID-a", "wrong");
  log.add("VUID-b", "also");
  ASSERT_EQ(log.messages().size(), 2u);
  EXPECT_EQ(log.messages()[0].count, 2u);
  EXPECT_EQ(log.messages()[1].id, "VUID-b");
  log.clear();
  EXPECT_TRUE(log.messages().empty());
  device().validationLog()->add("own", "own");
  EXPECT_EQ(device().validationMessages().size(), 1u);
  device().validationLog()->clear();
}

TEST_F(PublicDevice, FeaturesAreAddedToAChain) {
  const auto* needed = structureIn<VkPhysicalDeviceVulkan13Features>(
      requiredFeatures(), VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
  ASSERT_NE(needed, nullptr);
  EXPECT_TRUE(needed->maintenance4 && needed->synchronization2 && needed->dynamicRendering);
  EXPECT_TRUE(recommendedFeatures().features.shaderInt64);
  EXPECT_FALSE(requiredFeatures().features.shaderInt64);
  EXPECT_TRUE(requiredExtensions().empty());
  for (const char* name : recommendedExtensions()) EXPECT_EQ(std::string(name).rfind("VK_", 0), 0u) << name;

  VkPhysicalDeviceVulkan13Features v13{};
  v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  VkPhysicalDeviceVulkan12Features v12{};
  v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  v12.pNext = &v13;
  VkPhysicalDeviceFeatures2 chain{};
  chain.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  chain.pNext = &v12;
  addFeatures(chain, device().physicalDevice());
  EXPECT_TRUE(v12.timelineSemaphore && v13.maintenance4);
  v12.pNext = nullptr;
  expectRefused("dynamicRendering", [&] { addFeatures(chain, device().physicalDevice()); });
}

// tests/embed adopts a device of the test's own.
TEST_F(PublicDevice, AdoptsAnotherOnesHandles) {
  expectError(Error::Kind::device, "no features", [] { Device::adopt({}); });
  VkPhysicalDeviceVulkan13Features v13{};
  v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  VkPhysicalDeviceVulkan12Features v12{};
  v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  v12.pNext = &v13;
  VkPhysicalDeviceFeatures2 chain{};
  chain.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  chain.pNext = &v12;
  addFeatures(chain, device().physicalDevice());
  const AdoptedDevice handles{.instance = device().instance(),
                              .physicalDevice = device().physicalDevice(),
                              .device = device().handle(),
                              .queue = device().queue(),
                              .queueFamily = device().queueFamily(),
                              .features = &chain};
  const Device adopted = Device::adopt(handles);
  EXPECT_EQ(adopted.handle(), device().handle());
  EXPECT_EQ(adopted.report().name, device().report().name);
}

}  // namespace
}  // namespace skitter::test

#include <dlfcn.h>
#include <gmock/gmock.h>

#include <cstring>

#include "gpu/transfer.h"
#include "skitter/crowd.h"
#include "skitter/renderer.h"
#include "support/gpu_fixture.h"

// What a test of a queue that only computes looks at: the stages of every barrier that the engine records.
// The engine calls this in place of the loader's.
namespace {
VkPipelineStageFlags2 recordedStages = 0;
}
extern "C" VKAPI_ATTR void VKAPI_CALL vkCmdPipelineBarrier2(VkCommandBuffer commands,
                                                            const VkDependencyInfo* info) {
  for (uint32_t i = 0; i < info->memoryBarrierCount; ++i)
    recordedStages |= info->pMemoryBarriers[i].srcStageMask | info->pMemoryBarriers[i].dstStageMask;
  for (uint32_t i = 0; i < info->imageMemoryBarrierCount; ++i)
    recordedStages |= info->pImageMemoryBarriers[i].srcStageMask | info->pImageMemoryBarriers[i].dstStageMask;
  static const auto next =
      reinterpret_cast<PFN_vkCmdPipelineBarrier2>(dlsym(RTLD_NEXT, "vkCmdPipelineBarrier2"));
  next(commands, info);
}

namespace skitter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// What an application switches on for its device.
struct Chain {
  VkPhysicalDeviceVulkan13Features v13{};
  VkPhysicalDeviceVulkan12Features v12{};
  VkPhysicalDeviceFeatures2 core{};

  Chain() {
    v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    v12.pNext = &v13;
    core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    core.pNext = &v12;
  }
  Chain(const Chain&) = delete;
  Chain& operator=(const Chain&) = delete;
};

// An application's own device, by plain Vulkan calls, with what addFeatures asks for. Messages of the
// validation layer fail the test.
class Own {
 public:
  Own() {
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_3;
    const char* const layer = "VK_LAYER_KHRONOS_validation";
    const char* const debugUtils = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    VkDebugUtilsMessengerCreateInfoEXT messenger{};
    messenger.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    messenger.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger.pfnUserCallback = [](VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                   const VkDebugUtilsMessengerCallbackDataEXT* data, void*) -> VkBool32 {
      ADD_FAILURE() << data->pMessage;
      return VK_FALSE;
    };
    VkInstanceCreateInfo instanceInfo{};
    instanceInfo.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    instanceInfo.pNext = &messenger;
    instanceInfo.pApplicationInfo = &application;
    instanceInfo.enabledLayerCount = 1;
    instanceInfo.ppEnabledLayerNames = &layer;
    instanceInfo.enabledExtensionCount = 1;
    instanceInfo.ppEnabledExtensionNames = &debugUtils;
    EXPECT_EQ(vkCreateInstance(&instanceInfo, nullptr, &adopted.instance), VK_SUCCESS);
    const auto createMessenger = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(adopted.instance, "vkCreateDebugUtilsMessengerEXT"));
    EXPECT_EQ(createMessenger(adopted.instance, &messenger, nullptr, &messenger_), VK_SUCCESS);

    const uint32_t index = Device::create(test::validatedRequest()).report().index;
    std::vector<VkPhysicalDevice> all(index + 1);
    uint32_t count = index + 1;
    vkEnumeratePhysicalDevices(adopted.instance, &count, all.data());
    adopted.physicalDevice = all.at(index);
    addFeatures(chain.core, adopted.physicalDevice);

    const float priority = 1;
    VkDeviceQueueCreateInfo queueInfo{};
    queueInfo.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    VkDeviceCreateInfo deviceInfo{};
    deviceInfo.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    deviceInfo.pNext = &chain.core;
    deviceInfo.queueCreateInfoCount = 1;
    deviceInfo.pQueueCreateInfos = &queueInfo;
    EXPECT_EQ(vkCreateDevice(adopted.physicalDevice, &deviceInfo, nullptr, &adopted.device), VK_SUCCESS);
    vkGetDeviceQueue(adopted.device, 0, 0, &adopted.queue);
    adopted.features = &chain.core;
  }
  ~Own() {
    EXPECT_EQ(vkDeviceWaitIdle(adopted.device), VK_SUCCESS);
    vkDestroyDevice(adopted.device, nullptr);
    const auto destroyMessenger = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(adopted.instance, "vkDestroyDebugUtilsMessengerEXT"));
    destroyMessenger(adopted.instance, messenger_, nullptr);
    vkDestroyInstance(adopted.instance, nullptr);
  }
  Own(const Own&) = delete;
  Own& operator=(const Own&) = delete;

  std::string refusal() const {
    try {
      Device::adopt(adopted);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::device);
      return error.what();
    }
    ADD_FAILURE() << "it was adopted";
    return {};
  }

  Chain chain;
  AdoptedDevice adopted;

 private:
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

Scene fewAgents() {
  Scene scene;
  scene.terrain = TerrainNoise{.columns = 65, .rows = 65};
  scene.herds[0].agents = 20;
  return scene;
}

// The caller's own submission.
uint64_t hashAfter(const AdoptedDevice& adopted, Crowd& crowd, uint32_t ticks) {
  VkCommandPoolCreateInfo poolInfo{};
  poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  VkCommandPool pool = VK_NULL_HANDLE;
  EXPECT_EQ(vkCreateCommandPool(adopted.device, &poolInfo, nullptr, &pool), VK_SUCCESS);
  VkCommandBufferAllocateInfo commandsInfo{};
  commandsInfo.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  commandsInfo.commandPool = pool;
  commandsInfo.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  EXPECT_EQ(vkAllocateCommandBuffers(adopted.device, &commandsInfo, &commands), VK_SUCCESS);
  VkCommandBufferBeginInfo begin{};
  begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  EXPECT_EQ(vkBeginCommandBuffer(commands, &begin), VK_SUCCESS);
  for (uint32_t i = 0; i < ticks; ++i) crowd.record(commands, 1.0f / 60);
  EXPECT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
  VkSubmitInfo submit{};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  EXPECT_EQ(vkQueueSubmit(adopted.queue, 1, &submit, VK_NULL_HANDLE), VK_SUCCESS);
  const uint64_t hash = crowd.stateHash();
  EXPECT_EQ(vkQueueWaitIdle(adopted.queue), VK_SUCCESS);
  vkDestroyCommandPool(adopted.device, pool, nullptr);
  return hash;
}

TEST(Adopt, WorksOnTheCallersDeviceAndLeavesIt) {
  const Own own;
  for (int round = 0; round < 2; ++round) {
    Device device = Device::adopt(own.adopted);
    EXPECT_EQ(device.handle(), own.adopted.device);
    EXPECT_EQ(device.queue(), own.adopted.queue);
    EXPECT_TRUE(device.report().suitable);
    Device moved = std::move(device);
    const std::vector<uint32_t> data{1, 2, 3};
    const gpu::Buffer buffer(moved.context(), 12, "adopted");
    gpu::upload(moved.context(), buffer, data);
    EXPECT_EQ(gpu::download<uint32_t>(moved.context(), buffer), data);
    moved.waitIdle();
  }
}

TEST(Adopt, WalksAsOnACreatedDevice) {
  const Own own;
  Device adopted = Device::adopt(own.adopted), created = Device::create(test::validatedRequest());
  // The choices are measured on both, and what is close may come out either way: the bits are the same.
  EXPECT_EQ(adopted.report().loads.cost.has_value(), created.report().loads.cost.has_value());
  EXPECT_EQ(adopted.report().features.shaderInt64, created.report().features.shaderInt64);
  EXPECT_EQ(adopted.report().index, created.report().index);
  const Scene scene = fewAgents();
  const Heightfield ground = scene.loadTerrain();
  Crowd there(adopted, ground, scene), here(created, ground, scene);
  const AdoptedDevice ours{.device = created.handle(), .queue = created.queue()};
  EXPECT_EQ(hashAfter(own.adopted, there, 30), hashAfter(ours, here, 30));
}

TEST(Adopt, NamesAllThatIsMissingAtOnce) {
  Own own;
  const Chain nothing;
  own.adopted.features = &nothing.core;
  own.adopted.queueFamily = 99;
  own.adopted.loads = LoadPath::texel;
  EXPECT_THAT(
      own.refusal(),
      AllOf(HasSubstr("was made without dynamicRendering"), HasSubstr("was made without synchronization2"),
            HasSubstr("was made without maintenance4"), HasSubstr("was made without timelineSemaphore"),
            HasSubstr("no number 99"), HasSubstr("was made without shaderInt64")));
  for (const auto member : {&VkPhysicalDeviceVulkan13Features::dynamicRendering,
                            &VkPhysicalDeviceVulkan13Features::synchronization2,
                            &VkPhysicalDeviceVulkan13Features::maintenance4}) {
    Own one;
    one.chain.v13.*member = VK_FALSE;
    const std::string refusal = one.refusal();
    const size_t lacks = refusal.find("made without");
    ASSERT_NE(lacks, std::string::npos) << refusal;
    EXPECT_EQ(refusal.find(", ", lacks), std::string::npos) << refusal;
  }
}

TEST(Adopt, NamesEveryHandleThatIsNotGiven) {
  Own own;
  const AdoptedDevice whole = own.adopted;
  own.adopted = {.lockQueue = [] {}};
  EXPECT_THAT(own.refusal(), AllOf(HasSubstr("no instance"), HasSubstr("no physicalDevice"),
                                   HasSubstr("no device"), HasSubstr("no queue"), HasSubstr("no features"),
                                   HasSubstr("one of lockQueue and unlockQueue")));
  own.adopted = whole;
}

TEST(Adopt, TakesFeaturesFromTheirOwnStructures) {
  Own own;
  VkPhysicalDeviceTimelineSemaphoreFeatures timeline{};
  timeline.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES;
  timeline.timelineSemaphore = VK_TRUE;
  VkPhysicalDeviceMaintenance4Features maintenance{};
  maintenance.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES;
  maintenance.pNext = &timeline;
  maintenance.maintenance4 = VK_TRUE;
  VkPhysicalDeviceSynchronization2Features synchronization{};
  synchronization.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES;
  synchronization.pNext = &maintenance;
  synchronization.synchronization2 = VK_TRUE;
  VkPhysicalDeviceDynamicRenderingFeatures rendering{};
  rendering.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES;
  rendering.pNext = &synchronization;
  rendering.dynamicRendering = VK_TRUE;
  VkPhysicalDeviceFeatures2 core{};
  core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  core.pNext = &rendering;
  own.adopted.features = &core;
  const Device device = Device::adopt(own.adopted);
  EXPECT_FALSE(device.report().features.shaderInt64);
  EXPECT_EQ(device.report().loads.path, LoadPath::storage);
  timeline.timelineSemaphore = VK_FALSE;
  EXPECT_THAT(own.refusal(), HasSubstr("was made without timelineSemaphore"));
}

TEST(Adopt, AddsWhatIsWantedToAChainAndKeepsTheRest) {
  const Own own;
  Chain chain;
  chain.core.features.geometryShader = VK_TRUE;
  addFeatures(chain.core, own.adopted.physicalDevice);
  EXPECT_TRUE(chain.v13.dynamicRendering && chain.v13.synchronization2 && chain.v13.maintenance4);
  EXPECT_TRUE(chain.v12.timelineSemaphore);
  EXPECT_TRUE(chain.core.features.geometryShader);
  EXPECT_FALSE(chain.v13.inlineUniformBlock);
  VkPhysicalDeviceFeatures features;
  vkGetPhysicalDeviceFeatures(own.adopted.physicalDevice, &features);
  EXPECT_EQ(chain.core.features.shaderInt64, features.shaderInt64);
  chain.v12.pNext = nullptr;
  try {
    addFeatures(chain.core, own.adopted.physicalDevice);
    FAIL() << "a chain without VkPhysicalDeviceVulkan13Features was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    EXPECT_THAT(error.what(), HasSubstr("dynamicRendering"));
  }
}

TEST(Adopt, LocksTheQueueAboutEachSubmission) {
  Own own;
  int depth = 0, locks = 0;
  own.adopted.lockQueue = [&] {
    EXPECT_EQ(depth++, 0);
    ++locks;
  };
  own.adopted.unlockQueue = [&] { EXPECT_EQ(--depth, 0); };
  Device device = Device::adopt(own.adopted);
  EXPECT_EQ(depth, 0);
  const int before = locks;
  const gpu::Buffer buffer(device.context(), 12, "locked");
  gpu::upload(device.context(), buffer, std::vector<uint32_t>{1, 2, 3});
  EXPECT_EQ(locks, before + 1);
  device.waitIdle();
  EXPECT_EQ(locks, before + 2);
  EXPECT_EQ(depth, 0);
}

// What the engine asks Vulkan for is got through the caller's function, so that a test may answer in the
// driver's place.
std::vector<VkPipelineCache> cachesUsed;

VKAPI_ATTR VkResult VKAPI_CALL createComputePipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                      const VkComputePipelineCreateInfo* infos,
                                                      const VkAllocationCallbacks* allocator,
                                                      VkPipeline* pipelines) {
  cachesUsed.push_back(cache);
  return vkCreateComputePipelines(device, cache, count, infos, allocator, pipelines);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL deviceFunction(VkDevice device, const char* name) {
  // Tables of functions ask for this one, too, and go on with what they get.
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(deviceFunction);
  if (std::strcmp(name, "vkCreateComputePipelines") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(createComputePipelines);
  return vkGetDeviceProcAddr(device, name);
}

VKAPI_ATTR void VKAPI_CALL computeFamilies(VkPhysicalDevice physical, uint32_t* count,
                                           VkQueueFamilyProperties* families) {
  vkGetPhysicalDeviceQueueFamilyProperties(physical, count, families);
  for (uint32_t i = 0; families != nullptr && i < *count; ++i)
    families[i].queueFlags = VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL cacheWatching(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(deviceFunction);
  return vkGetInstanceProcAddr(instance, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL computeOnly(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkGetPhysicalDeviceQueueFamilyProperties") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(computeFamilies);
  return vkGetInstanceProcAddr(instance, name);
}

TEST(Adopt, MakesPipelinesThroughTheCallersCacheAndLeavesIt) {
  Own own;
  VkPipelineCacheCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO;
  VkPipelineCache cache = VK_NULL_HANDLE;
  ASSERT_EQ(vkCreatePipelineCache(own.adopted.device, &info, nullptr, &cache), VK_SUCCESS);
  own.adopted.pipelineCache = cache;
  own.adopted.getInstanceProcAddr = cacheWatching;
  cachesUsed.clear();
  {
    Device device = Device::adopt(own.adopted);
    const Scene scene = fewAgents();
    const Crowd crowd(device, scene.loadTerrain(), scene);
    EXPECT_FALSE(device.pipelineCacheData().empty());
  }
  EXPECT_GT(cachesUsed.size(), 5u);
  EXPECT_THAT(cachesUsed, ::testing::Each(cache));
  size_t bytes = 0;
  EXPECT_EQ(vkGetPipelineCacheData(own.adopted.device, cache, &bytes, nullptr), VK_SUCCESS);
  vkDestroyPipelineCache(own.adopted.device, cache, nullptr);
}

TEST(Adopt, WalksButDoesNotDrawOnAQueueThatOnlyComputes) {
  Own own;
  own.adopted.getInstanceProcAddr = computeOnly;
  Device device = Device::adopt(own.adopted);
  EXPECT_FALSE(device.report().features.graphics);
  EXPECT_EQ(device.report().lacks.front(), "graphics");
  const Scene scene = fewAgents();
  recordedStages = 0;
  Crowd crowd(device, scene.loadTerrain(), scene);
  crowd.editHeights(3, 3, 1, 1, std::vector{1.0f});
  hashAfter(own.adopted, crowd, 3);
  // Those that a queue without graphics may name.
  constexpr VkPipelineStageFlags2 allowed =
      VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT |
      VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_HOST_BIT |
      VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  EXPECT_NE(recordedStages, 0u);
  EXPECT_EQ(recordedStages & ~allowed, 0u);
  try {
    const Renderer renderer(device, crowd, 64, 64);
    FAIL() << "it draws on a queue that only computes";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::device);
    EXPECT_THAT(error.what(), HasSubstr("graphics"));
  }
}

TEST(PipelineCache, BeginsWithWhatAnEarlierDeviceHad) {
  DeviceRequest request = test::validatedRequest();
  std::vector<uint8_t> data = Device::create(request).pipelineCacheData();
  ASSERT_GE(data.size(), sizeof(VkPipelineCacheHeaderVersionOne));
  request.pipelineCache = data;
  const Device again = Device::create(request);
  EXPECT_GE(again.pipelineCacheData().size(), data.size());
  // What another driver wrote.
  request.pipelineCache[offsetof(VkPipelineCacheHeaderVersionOne, pipelineCacheUUID)] ^= 0xff;
  EXPECT_TRUE(Device::create(request).validationMessages().empty());
}

}  // namespace
}  // namespace skitter

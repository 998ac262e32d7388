#include "gpu.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "skitter/device.h"

namespace host {

void check(VkResult result, const char* call) {
  if (result < 0) throw std::runtime_error(std::string(call) + ": VkResult " + std::to_string(result));
}

VKAPI_ATTR VkBool32 VKAPI_CALL Gpu::say(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                        VkDebugUtilsMessageTypeFlagsEXT,
                                        const VkDebugUtilsMessengerCallbackDataEXT* data, void* gpu) {
  std::fprintf(stderr, "%s\n", data->pMessage);
  ++static_cast<Gpu*>(gpu)->messages_;
  return VK_FALSE;
}

namespace {

// The first family that has the flags and none of `without`.
std::optional<uint32_t> familyWith(const std::vector<VkQueueFamilyProperties>& families, VkQueueFlags flags,
                                   VkQueueFlags without) {
  for (uint32_t i = 0; i < families.size(); ++i)
    if ((families[i].queueFlags & flags) == flags && (families[i].queueFlags & without) == 0) return i;
  return {};
}

}  // namespace

Gpu::Gpu(const std::vector<const char*>& instanceExtensions, bool validate) {
  std::vector<const char*> wanted = instanceExtensions;
  std::vector<const char*> layers;
  const std::array checks = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
  const VkValidationFeaturesEXT validation{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                           .pNext = nullptr,
                                           .enabledValidationFeatureCount = checks.size(),
                                           .pEnabledValidationFeatures = checks.data(),
                                           .disabledValidationFeatureCount = 0,
                                           .pDisabledValidationFeatures = nullptr};
  if (validate) {
    layers.push_back("VK_LAYER_KHRONOS_validation");
    wanted.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  }
  VkApplicationInfo application{};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.pApplicationName = "skitter host";
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo instanceInfo{};
  instanceInfo.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  instanceInfo.pNext = validate ? &validation : nullptr;
  instanceInfo.pApplicationInfo = &application;
  instanceInfo.enabledLayerCount = static_cast<uint32_t>(layers.size());
  instanceInfo.ppEnabledLayerNames = layers.data();
  instanceInfo.enabledExtensionCount = static_cast<uint32_t>(wanted.size());
  instanceInfo.ppEnabledExtensionNames = wanted.data();
  VK_CHECK(vkCreateInstance(&instanceInfo, nullptr, &instance));
  if (validate) {
    VkDebugUtilsMessengerCreateInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType =
        VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    info.pfnUserCallback = say;
    info.pUserData = this;
    const auto make = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
    VK_CHECK(make(instance, &info, nullptr, &messenger_));
  }

  // The first device; a program of your own has a better choice.
  uint32_t count = 1;
  vkEnumeratePhysicalDevices(instance, &count, &physical);
  if (count == 0) throw std::runtime_error("there is no Vulkan device");
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  const auto both = familyWith(families, VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT, 0);
  if (!both) throw std::runtime_error("the device has no queue for graphics and compute");
  graphics.family = *both;
  compute.family = familyWith(families, VK_QUEUE_COMPUTE_BIT, VK_QUEUE_GRAPHICS_BIT).value_or(*both);

  const float priority = 1;
  std::vector<VkDeviceQueueCreateInfo> queues;
  for (const uint32_t family : {graphics.family, compute.family}) {
    if (!queues.empty() && queues[0].queueFamilyIndex == family) continue;
    queues.push_back({.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                      .pNext = nullptr,
                      .flags = 0,
                      .queueFamilyIndex = family,
                      .queueCount = 1,
                      .pQueuePriorities = &priority});
  }
  // What Skitter needs and likes, and nothing for the host's own drawing beyond it.
  features13_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  features12_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  features12_.pNext = &features13_;
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  features.pNext = &features12_;
  skitter::addFeatures(features, physical);
  if (!instanceExtensions.empty()) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  VkDeviceCreateInfo deviceInfo{};
  deviceInfo.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  deviceInfo.pNext = &features;
  deviceInfo.queueCreateInfoCount = static_cast<uint32_t>(queues.size());
  deviceInfo.pQueueCreateInfos = queues.data();
  deviceInfo.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  deviceInfo.ppEnabledExtensionNames = extensions.data();
  VK_CHECK(vkCreateDevice(physical, &deviceInfo, nullptr, &device));
  vkGetDeviceQueue(device, graphics.family, 0, &graphics.queue);
  vkGetDeviceQueue(device, compute.family, 0, &compute.queue);

  constexpr uint32_t mostSets = 256;
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 4 * mostSets};
  VkDescriptorPoolCreateInfo poolInfo{};
  poolInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  poolInfo.maxSets = mostSets;
  poolInfo.poolSizeCount = 1;
  poolInfo.pPoolSizes = &size;
  VK_CHECK(vkCreateDescriptorPool(device, &poolInfo, nullptr, &sets_));
}

Gpu::~Gpu() {
  if (device != VK_NULL_HANDLE) {
    vkDeviceWaitIdle(device);
    for (const VkSemaphore semaphore : semaphores_) vkDestroySemaphore(device, semaphore, nullptr);
    for (const VkCommandPool pool : pools_) vkDestroyCommandPool(device, pool, nullptr);
    for (const Pipeline& pipeline : pipelines_) {
      vkDestroyPipeline(device, pipeline.handle, nullptr);
      vkDestroyPipelineLayout(device, pipeline.layout, nullptr);
      vkDestroyDescriptorSetLayout(device, pipeline.setLayout, nullptr);
    }
    vkDestroyDescriptorPool(device, sets_, nullptr);
    for (const Image& image : images_) {
      vkDestroyImageView(device, image.view, nullptr);
      vkDestroyImage(device, image.handle, nullptr);
    }
    for (const VkBuffer buffer : buffers_) vkDestroyBuffer(device, buffer, nullptr);
    for (const VkDeviceMemory memory : memory_) vkFreeMemory(device, memory, nullptr);
    vkDestroyDevice(device, nullptr);
  }
  if (messenger_ != VK_NULL_HANDLE) {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
    destroy(instance, messenger_, nullptr);
  }
  vkDestroyInstance(instance, nullptr);
}

VkDeviceMemory Gpu::allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) {
  VkPhysicalDeviceMemoryProperties types;
  vkGetPhysicalDeviceMemoryProperties(physical, &types);
  for (uint32_t type = 0; type < types.memoryTypeCount; ++type) {
    if ((needs.memoryTypeBits >> type & 1) == 0) continue;
    if ((types.memoryTypes[type].propertyFlags & wanted) != wanted) continue;
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = needs.size;
    info.memoryTypeIndex = type;
    VkDeviceMemory& memory = memory_.emplace_back();
    VK_CHECK(vkAllocateMemory(device, &info, nullptr, &memory));
    return memory;
  }
  throw std::runtime_error("the device has no memory of that kind");
}

Buffer Gpu::makeBuffer(VkDeviceSize bytes, VkBufferUsageFlags usage, bool hostVisible) {
  Buffer buffer{.bytes = bytes};
  const std::array families = {graphics.family, compute.family};
  const bool shared = graphics.family != compute.family;
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = std::max<VkDeviceSize>(bytes, 16);
  info.usage = usage;
  info.sharingMode = shared ? VK_SHARING_MODE_CONCURRENT : VK_SHARING_MODE_EXCLUSIVE;
  info.queueFamilyIndexCount = shared ? 2 : 0;
  info.pQueueFamilyIndices = families.data();
  VK_CHECK(vkCreateBuffer(device, &info, nullptr, &buffer.handle));
  buffers_.push_back(buffer.handle);
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device, buffer.handle, &needs);
  const VkMemoryPropertyFlags wanted =
      hostVisible ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT
                  : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  const VkDeviceMemory memory = allocate(needs, wanted);
  VK_CHECK(vkBindBufferMemory(device, buffer.handle, memory, 0));
  if (hostVisible) VK_CHECK(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &buffer.mapped));
  return buffer;
}

// Host-visible memory is good enough for what is uploaded once in an example.
Buffer Gpu::upload(std::span<const std::byte> bytes, VkBufferUsageFlags usage) {
  const Buffer buffer = makeBuffer(bytes.size(), usage, true);
  std::memcpy(buffer.mapped, bytes.data(), bytes.size());
  return buffer;
}

Image Gpu::makeImage(VkExtent2D extent, VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect) {
  Image image{.extent = extent};
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {extent.width, extent.height, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = usage;
  VK_CHECK(vkCreateImage(device, &info, nullptr, &image.handle));
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device, image.handle, &needs);
  VK_CHECK(vkBindImageMemory(device, image.handle, allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT), 0));
  VkImageViewCreateInfo view{};
  view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  view.image = image.handle;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = format;
  view.subresourceRange = {aspect, 0, 1, 0, 1};
  VK_CHECK(vkCreateImageView(device, &view, nullptr, &image.view));
  images_.push_back(image);
  return image;
}

VkShaderModule Gpu::module(std::span<const uint32_t> code) {
  VkShaderModuleCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  info.codeSize = code.size_bytes();
  info.pCode = code.data();
  VkShaderModule made = VK_NULL_HANDLE;
  VK_CHECK(vkCreateShaderModule(device, &info, nullptr, &made));
  return made;
}

Pipeline Gpu::makeLayout(VkPipelineBindPoint point, VkShaderStageFlags stages, uint32_t storageBuffers,
                         uint32_t pushBytes) {
  Pipeline pipeline{.point = point, .stages = stages, .storageBuffers = storageBuffers};
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (uint32_t i = 0; i < storageBuffers; ++i)
    bindings.push_back({i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, stages, nullptr});
  VkDescriptorSetLayoutCreateInfo setInfo{};
  setInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  setInfo.bindingCount = storageBuffers;
  setInfo.pBindings = bindings.data();
  VK_CHECK(vkCreateDescriptorSetLayout(device, &setInfo, nullptr, &pipeline.setLayout));
  const VkPushConstantRange push{stages, 0, pushBytes};
  VkPipelineLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  info.setLayoutCount = 1;
  info.pSetLayouts = &pipeline.setLayout;
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &push;
  VK_CHECK(vkCreatePipelineLayout(device, &info, nullptr, &pipeline.layout));
  return pipeline;
}

Pipeline Gpu::makeCompute(std::span<const uint32_t> code, uint32_t storageBuffers, uint32_t pushBytes) {
  Pipeline pipeline =
      makeLayout(VK_PIPELINE_BIND_POINT_COMPUTE, VK_SHADER_STAGE_COMPUTE_BIT, storageBuffers, pushBytes);
  VkComputePipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = module(code);
  info.stage.pName = "main";
  info.layout = pipeline.layout;
  VK_CHECK(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline.handle));
  vkDestroyShaderModule(device, info.stage.module, nullptr);
  pipelines_.push_back(pipeline);
  return pipeline;
}

Pipeline Gpu::makeDrawing(const Drawing& drawing) {
  Pipeline pipeline =
      makeLayout(VK_PIPELINE_BIND_POINT_GRAPHICS, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT,
                 drawing.storageBuffers, drawing.pushBytes);
  std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
  for (size_t i = 0; i < 2; ++i) {
    stages[i].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    stages[i].stage = i == 0 ? VK_SHADER_STAGE_VERTEX_BIT : VK_SHADER_STAGE_FRAGMENT_BIT;
    stages[i].module = module(i == 0 ? drawing.vertex : drawing.fragment);
    stages[i].pName = "main";
  }
  std::vector<VkVertexInputAttributeDescription> attributes;
  for (uint32_t i = 0; i < drawing.attributes.size(); ++i)
    attributes.push_back({i, 0, drawing.attributes[i].format, drawing.attributes[i].offset});
  const VkVertexInputBindingDescription stream{0, drawing.vertexStride, VK_VERTEX_INPUT_RATE_VERTEX};
  VkPipelineVertexInputStateCreateInfo input{};
  input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
  input.vertexBindingDescriptionCount = attributes.empty() ? 0 : 1;
  input.pVertexBindingDescriptions = &stream;
  input.vertexAttributeDescriptionCount = static_cast<uint32_t>(attributes.size());
  input.pVertexAttributeDescriptions = attributes.data();
  VkPipelineInputAssemblyStateCreateInfo assembly{};
  assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPipelineViewportStateCreateInfo viewport{};
  viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
  viewport.viewportCount = viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{};
  raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
  raster.cullMode = VK_CULL_MODE_BACK_BIT;
  raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  raster.lineWidth = 1;
  VkPipelineMultisampleStateCreateInfo samples{};
  samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineDepthStencilStateCreateInfo depth{};
  depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
  depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
  depth.depthCompareOp = VK_COMPARE_OP_LESS;
  VkPipelineColorBlendAttachmentState blendOne{};
  blendOne.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT |
                            VK_COLOR_COMPONENT_A_BIT;
  VkPipelineColorBlendStateCreateInfo blend{};
  blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
  blend.attachmentCount = 1;
  blend.pAttachments = &blendOne;
  const std::array dynamic = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamicInfo{};
  dynamicInfo.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
  dynamicInfo.dynamicStateCount = dynamic.size();
  dynamicInfo.pDynamicStates = dynamic.data();
  VkPipelineRenderingCreateInfo rendering{};
  rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachmentFormats = &drawing.colour;
  rendering.depthAttachmentFormat = drawing.depth;
  VkGraphicsPipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
  info.pNext = &rendering;
  info.stageCount = stages.size();
  info.pStages = stages.data();
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamicInfo;
  info.layout = pipeline.layout;
  VK_CHECK(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline.handle));
  for (const auto& stage : stages) vkDestroyShaderModule(device, stage.module, nullptr);
  pipelines_.push_back(pipeline);
  return pipeline;
}

VkDescriptorSet Gpu::bind(const Pipeline& pipeline, const std::vector<VkBuffer>& buffers) {
  VkDescriptorSetAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  info.descriptorPool = sets_;
  info.descriptorSetCount = 1;
  info.pSetLayouts = &pipeline.setLayout;
  VkDescriptorSet set = VK_NULL_HANDLE;
  VK_CHECK(vkAllocateDescriptorSets(device, &info, &set));
  for (uint32_t i = 0; i < buffers.size(); ++i) {
    const VkDescriptorBufferInfo buffer{buffers[i], 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set;
    write.dstBinding = i;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    write.pBufferInfo = &buffer;
    vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
  }
  return set;
}

VkCommandPool Gpu::makePool(uint32_t family) {
  VkCommandPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  info.queueFamilyIndex = family;
  VK_CHECK(vkCreateCommandPool(device, &info, nullptr, &pools_.emplace_back()));
  return pools_.back();
}

VkCommandBuffer Gpu::makeCommands(VkCommandPool pool) {
  VkCommandBufferAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  info.commandPool = pool;
  info.commandBufferCount = 1;
  VkCommandBuffer cmd = VK_NULL_HANDLE;
  VK_CHECK(vkAllocateCommandBuffers(device, &info, &cmd));
  return cmd;
}

VkSemaphore Gpu::makeTimeline() {
  VkSemaphoreTypeCreateInfo type{};
  type.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO;
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  VkSemaphoreCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
  info.pNext = &type;
  VK_CHECK(vkCreateSemaphore(device, &info, nullptr, &semaphores_.emplace_back()));
  return semaphores_.back();
}

VkSemaphore Gpu::makeSemaphore() {
  VkSemaphoreCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
  VK_CHECK(vkCreateSemaphore(device, &info, nullptr, &semaphores_.emplace_back()));
  return semaphores_.back();
}

void barrier(VkCommandBuffer cmd, VkPipelineStageFlags2 from, VkAccessFlags2 written,
             VkPipelineStageFlags2 to, VkAccessFlags2 access) {
  VkMemoryBarrier2 memory{};
  memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
  memory.srcStageMask = from;
  memory.srcAccessMask = written;
  memory.dstStageMask = to;
  memory.dstAccessMask = access;
  VkDependencyInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &memory;
  vkCmdPipelineBarrier2(cmd, &info);
}

void transition(VkCommandBuffer cmd, VkImage image, VkImageAspectFlags aspect, VkImageLayout before,
                VkImageLayout after, VkPipelineStageFlags2 from, VkAccessFlags2 written,
                VkPipelineStageFlags2 to, VkAccessFlags2 access) {
  VkImageMemoryBarrier2 one{};
  one.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
  one.srcStageMask = from;
  one.srcAccessMask = written;
  one.dstStageMask = to;
  one.dstAccessMask = access;
  one.oldLayout = before;
  one.newLayout = after;
  one.srcQueueFamilyIndex = one.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  one.image = image;
  one.subresourceRange = {aspect, 0, 1, 0, 1};
  VkDependencyInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &one;
  vkCmdPipelineBarrier2(cmd, &info);
}

}  // namespace host

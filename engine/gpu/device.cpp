#include "skitter/device.h"

#include "gpu/adopt.h"
#include "gpu/choice.h"
#include "gpu/context.h"
#include "gpu/extensions.h"
#include "gpu/instance.h"
#include "gpu/record_access.h"

#include <fmt/format.h>

namespace skitter {
namespace {

vk::raii::Device makeDevice(const gpu::Candidate& candidate, bool presentation) {
  const DeviceFeatures& has = candidate.report.features;
  vk::PhysicalDeviceVulkan13Features v13{
      .synchronization2 = true, .dynamicRendering = true, .maintenance4 = true};
  vk::PhysicalDeviceVulkan12Features v12{
      .pNext = &v13, .drawIndirectCount = has.drawIndirectCount, .timelineSemaphore = true};
  vk::PhysicalDeviceVulkan11Features v11{.pNext = &v12, .shaderDrawParameters = has.shaderDrawParameters};
  const vk::PhysicalDeviceFeatures2 features{
      .pNext = &v11,
      .features = {.multiDrawIndirect = has.multiDrawIndirect,
                   .drawIndirectFirstInstance = has.drawIndirectFirstInstance,
                   .fillModeNonSolid = has.fillModeNonSolid,
                   .samplerAnisotropy = has.samplerAnisotropy,
                   .shaderInt64 = has.shaderInt64}};

  std::vector<const char*> extensions;
  if (presentation) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  if (gpu::hasExtension(candidate.physical, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME)) {
    extensions.push_back(VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
  }

  const float priority = 1;
  const vk::DeviceQueueCreateInfo queue{
      .queueFamilyIndex = candidate.queueFamily, .queueCount = 1, .pQueuePriorities = &priority};
  const vk::DeviceCreateInfo info{.pNext = &features,
                                  .queueCreateInfoCount = 1,
                                  .pQueueCreateInfos = &queue,
                                  .enabledExtensionCount = uint32_t(extensions.size()),
                                  .ppEnabledExtensionNames = extensions.data()};
  return gpu::guarded(fmt::format("opening the device \"{}\"", candidate.report.name),
                      [&] { return vk::raii::Device(candidate.physical, info); });
}

std::unique_ptr<gpu::Context> open(gpu::Context::Parts parts, const DeviceRequest& request) {
  auto context = std::make_unique<gpu::Context>(std::move(parts));
  gpu::chooseAccess(*context, request);
  return context;
}

}  // namespace

const char* DeviceReport::typeName() const {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "cpu";
    default:
      return "other";
  }
}

std::vector<ValidationMessage> ValidationLog::messages() const {
  const std::lock_guard lock(mutex_);
  return messages_;
}

void ValidationLog::clear() {
  const std::lock_guard lock(mutex_);
  messages_.clear();
}

void ValidationLog::add(std::string id, std::string text) {
  const std::lock_guard lock(mutex_);
  for (ValidationMessage& message : messages_) {
    if (message.id == id && message.text == text) {
      ++message.count;
      return;
    }
  }
  messages_.push_back({std::move(id), std::move(text), 1});
}

std::vector<DeviceReport> listDevices(const DeviceRequest& request) {
  const gpu::Instance instance = gpu::makeInstance(request);
  std::vector<DeviceReport> reports;
  gpu::guarded("listing the Vulkan devices", [&] {
    for (gpu::Candidate& candidate : gpu::candidates(instance.instance, request)) {
      reports.push_back(std::move(candidate.report));
    }
  });
  return reports;
}

Device Device::create(const DeviceRequest& request) {
  gpu::Instance instance = gpu::makeInstance(request);
  auto all =
      gpu::guarded("listing the Vulkan devices", [&] { return gpu::candidates(instance.instance, request); });
  gpu::Candidate& candidate = gpu::chosen(all, request);
  vk::raii::Device device = makeDevice(candidate, request.presentation);
  vk::raii::Queue queue(device, candidate.queueFamily, 0);
  candidate.report.features.presentation = request.presentation;
  return Device(open({.log = std::move(instance.log),
                      .loader = std::move(instance.loader),
                      .instance = std::move(instance.instance),
                      .messenger = std::move(instance.messenger),
                      .physical = std::move(candidate.physical),
                      .device = std::move(device),
                      .queue = std::move(queue),
                      .queueFamily = candidate.queueFamily,
                      .debugUtils = instance.debugUtils,
                      .report = std::move(candidate.report)},
                     request));
}

Device Device::adopt(VkInstance instance, VkPhysicalDevice physicalDevice, VkDevice device,
                     uint32_t queueFamily, VkQueue queue, PFN_vkGetInstanceProcAddr getInstanceProcAddr,
                     std::optional<LoadPath> loads) {
  gpu::Context::Parts parts{.log = std::make_shared<ValidationLog>(),
                            .loader = vk::raii::Context(getInstanceProcAddr),
                            .queueFamily = queueFamily,
                            .report = {}};
  parts.instance = gpu::adoptInstance(parts.loader, instance);
  gpu::Candidate candidate = gpu::guarded("adopting a device", [&] {
    return gpu::inspect(vk::raii::PhysicalDevice(parts.instance, physicalDevice), 0, {.loads = loads},
                        queueFamily);
  });
  if (!candidate.report.suitable) {
    throw deviceError(fmt::format("the adopted device \"{}\" ({}) {}", candidate.report.name,
                                  candidate.report.typeName(), candidate.report.whyNot));
  }
  candidate.report.chosen = true;
  parts.report = std::move(candidate.report);
  parts.physical = std::move(candidate.physical);
  parts.device = gpu::adoptDevice(parts.physical, device);
  parts.queue = vk::raii::Queue(parts.device, queue);
  return Device(open(std::move(parts), {.loads = loads}));
}

Device::Device(std::unique_ptr<gpu::Context> context) : context_(std::move(context)) {}
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;
Device::~Device() = default;

const DeviceReport& Device::report() const { return context_->report(); }
VkDevice Device::handle() const { return *context_->device(); }
VkInstance Device::instance() const { return *context_->instance(); }
VkPhysicalDevice Device::physicalDevice() const { return *context_->physical(); }
VkQueue Device::queue() const { return *context_->queue(); }
uint32_t Device::queueFamily() const { return context_->queueFamily(); }
void Device::waitIdle() const { context_->waitIdle(); }

std::vector<ValidationMessage> Device::validationMessages() const {
  return context_->validationLog()->messages();
}
std::shared_ptr<ValidationLog> Device::validationLog() const { return context_->validationLog(); }

}  // namespace skitter

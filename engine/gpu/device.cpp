#include "skitter/device.h"

#include "gpu/adopt.h"
#include "gpu/choice.h"
#include "gpu/context.h"
#include "gpu/extensions.h"
#include "gpu/features.h"
#include "gpu/instance.h"
#include "gpu/record_access.h"
#include "gpu/submit.h"
#include "skitter/error.h"

#include <fmt/format.h>

#include <cstring>

namespace skitter {
namespace {

vk::raii::Device makeDevice(const gpu::Candidate& candidate, bool presentation) {
  gpu::FeatureChain features;
  for (const gpu::Feature& feature : gpu::allFeatures)
    *feature.in(features.core) = feature.isRequired() || candidate.report.features.*feature.reported;

  std::vector<const char*> extensions;
  if (presentation) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  for (const char* extension : recommendedExtensions())
    if (gpu::hasExtension(candidate.physical, extension)) extensions.push_back(extension);

  const float priority = 1;
  const vk::DeviceQueueCreateInfo queue{
      .queueFamilyIndex = candidate.queueFamily, .queueCount = 1, .pQueuePriorities = &priority};
  const vk::DeviceCreateInfo info{.pNext = &features.core,
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
                      .report = std::move(candidate.report),
                      .pipelineCache = request.pipelineCache},
                     request));
}

Device Device::adopt(const AdoptedDevice& adopted) {
  std::vector<std::string> missing;
  const auto needs = [&](bool given, const char* what) {
    if (!given) missing.push_back(what);
  };
  needs(adopted.instance, "no instance");
  needs(adopted.physicalDevice, "no physicalDevice");
  needs(adopted.device, "no device");
  needs(adopted.queue, "no queue");
  needs(adopted.features, "no features, of which the chain says what was enabled");
  needs(!adopted.lockQueue == !adopted.unlockQueue, "one of lockQueue and unlockQueue alone");
  if (!missing.empty())
    throw deviceError(fmt::format("the adopted device comes with {}", fmt::join(missing, ", ")));

  gpu::Context::Parts parts{
      .log = std::make_shared<ValidationLog>(),
      .loader = vk::raii::Context(adopted.getInstanceProcAddr ? adopted.getInstanceProcAddr
                                                              : vkGetInstanceProcAddr),
      .queueFamily = adopted.queueFamily,
      .report = {},
      .adopted = true,
      .lockQueue = adopted.lockQueue,
      .unlockQueue = adopted.unlockQueue,
      .hostsCache = adopted.pipelineCache};
  parts.instance = gpu::adoptInstance(parts.loader, adopted.instance);
  for (const char* extension : adopted.extensions)
    parts.debugUtils = parts.debugUtils || std::strcmp(extension, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) == 0;
  const DeviceRequest request{.loads = adopted.loads, .stores = adopted.stores};
  gpu::Candidate candidate = gpu::guarded("adopting a device", [&] {
    const auto index = gpu::indexOf(parts.instance, adopted.physicalDevice);
    if (!index)
      throw deviceError("the adopted device comes with a physicalDevice that its instance does not have");
    return gpu::inspect(vk::raii::PhysicalDevice(parts.instance, adopted.physicalDevice), *index, request,
                        &adopted);
  });
  if (!candidate.report.suitable) {
    throw deviceError(fmt::format("the adopted device \"{}\" ({}) {}", candidate.report.name,
                                  candidate.report.typeName(), candidate.report.whyNot));
  }
  candidate.report.chosen = true;
  parts.report = std::move(candidate.report);
  parts.physical = std::move(candidate.physical);
  parts.device = gpu::adoptDevice(parts.physical, adopted.device);
  parts.queue = vk::raii::Queue(parts.device, adopted.queue);
  return Device(open(std::move(parts), request));
}

Device::Device(std::unique_ptr<gpu::Context> context) : context_(std::move(context)) {}
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;
Device::~Device() = default;

const DeviceReport& Device::report() const { return context_->report(); }
VkDevice Device::handle() const { return *context_->device(); }
VkInstance Device::instance() const { return *context_->instance(); }
VkPhysicalDevice Device::physicalDevice() const { return *context_->physical(); }
VkQueue Device::queue() const { return context_->queueHandle(); }
uint32_t Device::queueFamily() const { return context_->queueFamily(); }
void Device::waitIdle() const { context_->waitIdle(); }
void Device::run(const std::function<void(VkCommandBuffer)>& record) const {
  if (!record) throw inputError("Device::run was given no function, expected one that records commands");
  gpu::submitAndWait(*context_, record);
}
std::vector<uint8_t> Device::pipelineCacheData() const {
  return gpu::guarded("reading the pipeline cache", [&] { return context_->pipelineCache().getData(); });
}

std::vector<ValidationMessage> Device::validationMessages() const {
  return context_->validationLog()->messages();
}
std::shared_ptr<ValidationLog> Device::validationLog() const { return context_->validationLog(); }

}  // namespace skitter

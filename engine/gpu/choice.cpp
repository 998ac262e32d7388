#include "gpu/choice.h"

#include "gpu/context.h"
#include "gpu/device_memory.h"
#include "gpu/extensions.h"
#include "gpu/features.h"
#include "gpu/record_access.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>

namespace skitter::gpu {
namespace {

constexpr uint32_t kLargestHeightfield = 16384;  // samples a side that files may have

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

int rankOf(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 4;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 3;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return 1;
    default:
      return 0;
  }
}

std::optional<uint32_t> findQueueFamily(const std::vector<vk::QueueFamilyProperties>& families) {
  constexpr auto wanted = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;
  for (uint32_t i = 0; i < families.size(); ++i) {
    if (families[i].queueCount > 0 && (families[i].queueFlags & wanted) == wanted) return i;
  }
  return {};
}

bool isAmong(std::span<const char* const> names, const char* wanted) {
  return std::any_of(names.begin(), names.end(),
                     [&](const char* name) { return std::strcmp(name, wanted) == 0; });
}

void inspectFeatures(const vk::raii::PhysicalDevice& physical, const AdoptedDevice* adopted,
                     DeviceReport& report) {
  FeatureChain has;
  physical.getDispatcher()->vkGetPhysicalDeviceFeatures2(*physical, &has.core);
  const VkPhysicalDeviceFeatures2& chain = adopted ? *adopted->features : has.core;
  const char* const without = adopted ? "was made without" : "has no";
  for (const Feature& feature : allFeatures) {
    const bool on = feature.isOnIn(chain);
    if (!feature.isRequired())
      report.features.*feature.reported = on;
    else if (!on)
      report.refusals.push_back(fmt::format("{} {}", without, feature.name));
  }
  const auto extends = [&](const char* extension) {
    return adopted ? isAmong(adopted->extensions, extension) : hasExtension(physical, extension);
  };
  for (const char* extension : requiredExtensions())
    if (!extends(extension)) report.refusals.push_back(fmt::format("{} {}", without, extension));
  report.features.presentation = extends(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
}

void inspectLimits(const vk::raii::PhysicalDevice& physical, DeviceReport& report) {
  const auto chain =
      physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties,
                              vk::PhysicalDeviceVulkan12Properties, vk::PhysicalDeviceVulkan13Properties>();
  const auto& core = chain.get<vk::PhysicalDeviceProperties2>().properties.limits;
  const auto& v11 = chain.get<vk::PhysicalDeviceVulkan11Properties>();
  const auto& v12 = chain.get<vk::PhysicalDeviceVulkan12Properties>();
  const auto& v13 = chain.get<vk::PhysicalDeviceVulkan13Properties>();
  report.driver = fmt::format("{} {}", v12.driverName.data(), v12.driverInfo.data());

  DeviceLimits& limits = report.limits;
  limits.subgroupSize = v11.subgroupSize;
  limits.maxStorageBufferRange = core.maxStorageBufferRange;
  limits.maxTexelBufferElements = core.maxTexelBufferElements;
  limits.minTexelBufferOffsetAlignment = core.minTexelBufferOffsetAlignment;
  limits.minStorageBufferOffsetAlignment = core.minStorageBufferOffsetAlignment;
  limits.minUniformBufferOffsetAlignment = core.minUniformBufferOffsetAlignment;
  limits.maxAllocationBytes = std::min(v11.maxMemoryAllocationSize, v13.maxBufferSize);
  limits.maxImageDimension2D = core.maxImageDimension2D;
  limits.maxComputeWorkGroupInvocations = core.maxComputeWorkGroupInvocations;
  limits.maxComputeWorkGroupCountX = core.maxComputeWorkGroupCount[0];
  limits.maxPushConstantsSize = core.maxPushConstantsSize;
  limits.heapBytes = largestDeviceHeap(physical.getMemoryProperties());
  FreeMemory available = availableMemory(physical);
  limits.availableBytes = available.bytes;
  limits.availableOf = std::move(available.of);
  limits.timestampPeriod = double(core.timestampPeriod);
  limits.texelRgba32f = bool(physical.getFormatProperties(vk::Format::eR32G32B32A32Sfloat).bufferFeatures &
                             vk::FormatFeatureFlagBits::eUniformTexelBuffer);
  limits.sampledR32f = bool(physical.getFormatProperties(vk::Format::eR32Sfloat).optimalTilingFeatures &
                            vk::FormatFeatureFlagBits::eSampledImage);
  if (!limits.sampledR32f) report.refusals.push_back("cannot sample R32_SFLOAT images");
}

void inspectQueue(const vk::raii::PhysicalDevice& physical, const AdoptedDevice* adopted,
                  Candidate& candidate) {
  DeviceReport& report = candidate.report;
  const auto families = physical.getQueueFamilyProperties();
  const auto family = adopted ? std::optional(adopted->queueFamily) : findQueueFamily(families);
  if (!family) {
    report.refusals.push_back("has no queue for graphics and compute");
  } else if (*family >= families.size()) {
    report.refusals.push_back(
        fmt::format("has {} queue families, so no number {}", families.size(), *family));
  } else if (!(families[*family].queueFlags & vk::QueueFlagBits::eCompute)) {
    report.refusals.push_back(fmt::format("queue family {} does not compute", *family));
  } else {
    candidate.queueFamily = *family;
    report.features.graphics = bool(families[*family].queueFlags & vk::QueueFlagBits::eGraphics);
    report.limits.timestampBits = families[*family].timestampValidBits;
  }
}

void listLacks(DeviceReport& report) {
  const DeviceLimits& limits = report.limits;
  const auto lack = [&](bool has, std::string what) {
    if (!has) report.lacks.push_back(std::move(what));
  };
  lack(report.features.graphics, "graphics");
  for (const Feature& feature : allFeatures)
    if (!feature.isRequired()) lack(report.features.*feature.reported, feature.name);
  lack(report.features.presentation, "windows (VK_KHR_swapchain)");
  lack(limits.timestampBits > 0, "timestamps");
  lack(limits.texelRgba32f, "RGBA32F texel buffers");
  lack(!limits.texelRgba32f || limits.maxTexelBufferElements >= kEnoughTexels,
       fmt::format("texel buffers beyond {} vec4", limits.maxTexelBufferElements));
  lack(limits.maxImageDimension2D >= kLargestHeightfield,
       fmt::format("heightfields beyond {} samples a side", limits.maxImageDimension2D));
}

std::string describe(const DeviceReport& report) {
  return fmt::format("{} \"{}\" ({})", report.index, report.name, report.typeName());
}

std::string joined(const std::vector<std::string>& parts, const char* separator) {
  return fmt::format("{}", fmt::join(parts, separator));
}

std::optional<uint32_t> asIndex(const std::string& selector) {
  uint32_t index = 0;
  const auto [end, error] = std::from_chars(selector.data(), selector.data() + selector.size(), index);
  if (error != std::errc() || end != selector.data() + selector.size()) return {};
  return index;
}

bool selects(const std::string& selector, const DeviceReport& report) {
  if (const auto index = asIndex(selector)) return report.index == *index;
  return lower(report.name).find(lower(selector)) != std::string::npos;
}

}  // namespace

Candidate inspect(vk::raii::PhysicalDevice physical, uint32_t index, const DeviceRequest& request,
                  const AdoptedDevice* adopted) {
  Candidate candidate{.physical = std::move(physical), .report = {}};
  const vk::raii::PhysicalDevice& device = candidate.physical;
  DeviceReport& report = candidate.report;
  const auto properties = device.getProperties();
  report.name = properties.deviceName.data();
  report.index = index;
  report.type = VkPhysicalDeviceType(properties.deviceType);
  report.apiVersion = properties.apiVersion;
  if (report.apiVersion < VK_API_VERSION_1_3) {
    // What 1.3 knows cannot even be asked.
    report.refusals.push_back(fmt::format("has Vulkan {}.{}, not 1.3",
                                          VK_API_VERSION_MAJOR(report.apiVersion),
                                          VK_API_VERSION_MINOR(report.apiVersion)));
  } else {
    inspectLimits(device, report);
    inspectFeatures(device, adopted, report);
    inspectQueue(device, adopted, candidate);
    listLacks(report);
    if (wantedLoads(request.loads) == LoadPath::texel) {
      if (!report.limits.texelRgba32f)
        report.refusals.push_back("has no RGBA32F texel buffers, which were asked for");
      if (!report.features.shaderInt64)
        report.refusals.push_back(fmt::format("{} shaderInt64 for the texel buffers that were asked for",
                                              adopted ? "was made without" : "has no"));
    }
    if (request.presentation && !report.features.presentation) {
      report.refusals.push_back("has no VK_KHR_swapchain, which showing a window needs");
    }
  }
  report.suitable = report.refusals.empty();
  report.whyNot = joined(report.refusals, ", ");
  return candidate;
}

std::vector<Candidate> candidates(const vk::raii::Instance& instance, const DeviceRequest& request) {
  std::vector<Candidate> all;
  uint32_t index = 0;
  for (vk::raii::PhysicalDevice& physical : vk::raii::PhysicalDevices(instance)) {
    all.push_back(inspect(std::move(physical), index++, request));
  }

  Candidate* best = nullptr;
  for (Candidate& candidate : all) {
    DeviceReport& report = candidate.report;
    if (request.device && !selects(*request.device, report)) {
      report.whyNot = fmt::format("is not \"{}\", which was asked for", *request.device);
    } else if (report.suitable && (!best || rankOf(report.type) > rankOf(best->report.type))) {
      best = &candidate;
    }
  }
  if (!best) return all;
  best->report.chosen = true;
  for (Candidate& candidate : all) {
    if (!candidate.report.chosen && candidate.report.whyNot.empty()) {
      candidate.report.whyNot = fmt::format("comes after {}", describe(best->report));
    }
  }
  return all;
}

Candidate& chosen(std::vector<Candidate>& all, const DeviceRequest& request) {
  for (Candidate& candidate : all) {
    if (candidate.report.chosen) return candidate;
  }
  if (all.empty()) {
    throw deviceError("there is a Vulkan driver but no device (on Debian: apt install mesa-vulkan-drivers)");
  }
  std::vector<std::string> present;
  std::vector<std::string> refused;
  for (const Candidate& candidate : all) {
    const DeviceReport& report = candidate.report;
    present.push_back(describe(report));
    if (!request.device || selects(*request.device, report)) {
      refused.push_back(fmt::format("{} {}", describe(report), report.whyNot));
    }
  }
  if (refused.empty()) {
    throw deviceError(
        fmt::format("there is no Vulkan device \"{}\"; present: {}", *request.device, joined(present, "; ")));
  }
  throw deviceError(fmt::format("no Vulkan device is suitable: {}", joined(refused, "; ")));
}

}  // namespace skitter::gpu

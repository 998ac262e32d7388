#include "gpu/instance.h"

#include "gpu/context.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace skitter::gpu {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL listen(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                      const VkDebugUtilsMessengerCallbackDataEXT* data, void* log) {
  static_cast<ValidationLog*>(log)->add(data->pMessageIdName ? data->pMessageIdName : "",
                                        data->pMessage ? data->pMessage : "");
  return VK_FALSE;
}

// Only the validation type: the general type carries the loader's remarks on other drivers of the machine.
vk::DebugUtilsMessengerCreateInfoEXT messengerInfo(ValidationLog* log) {
  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  return {.messageSeverity = Severity::eWarning | Severity::eError,
          .messageType = vk::DebugUtilsMessageTypeFlagBitsEXT::eValidation,
          .pfnUserCallback = listen,
          .pUserData = log};
}

bool contains(const std::vector<vk::ExtensionProperties>& list, const std::string& name) {
  return std::any_of(list.begin(), list.end(),
                     [&](const auto& extension) { return name == extension.extensionName.data(); });
}

}  // namespace

Instance makeInstance(const DeviceRequest& request) {
  Instance made{.log = std::make_shared<ValidationLog>(), .loader = vk::raii::Context(vkGetInstanceProcAddr)};
  const vk::raii::Context& loader = made.loader;

  const uint32_t version = loader.enumerateInstanceVersion();
  if (version < VK_API_VERSION_1_3) {
    throw deviceError(fmt::format("the Vulkan loader is version {}.{}; 1.3 is needed",
                                  VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version)));
  }

  std::vector<const char*> layers;
  std::vector<vk::ExtensionProperties> available = loader.enumerateInstanceExtensionProperties();
  std::vector<const char*> extensions;
  if (request.validation) {
    const auto present = loader.enumerateInstanceLayerProperties();
    if (std::none_of(present.begin(), present.end(), [](const auto& layer) {
          return std::strcmp(layer.layerName.data(), kValidationLayer) == 0;
        })) {
      throw deviceError(fmt::format(
          "validation was asked for, but there is no {} (on Debian: apt install vulkan-validationlayers)",
          kValidationLayer));
    }
    layers.push_back(kValidationLayer);
    extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    const auto ofLayer = loader.enumerateInstanceExtensionProperties(std::string(kValidationLayer));
    available.insert(available.end(), ofLayer.begin(), ofLayer.end());
  }
  made.debugUtils = contains(available, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  if (made.debugUtils) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  if (request.presentation) {
    extensions.push_back(VK_KHR_SURFACE_EXTENSION_NAME);
    for (const std::string& extension : request.instanceExtensions) {
      if (extension != VK_KHR_SURFACE_EXTENSION_NAME) extensions.push_back(extension.c_str());
    }
  }
  for (const char* extension : extensions) {
    if (!contains(available, extension)) {
      throw deviceError(
          fmt::format("no Vulkan driver of this machine has the instance extension {}", extension));
    }
  }

  const vk::ApplicationInfo application{
      .pApplicationName = "skitter", .pEngineName = "skitter", .apiVersion = VK_API_VERSION_1_3};
  const auto messenger = messengerInfo(made.log.get());
  const auto synchronization = vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
  const vk::ValidationFeaturesEXT features{.pNext = &messenger,
                                           .enabledValidationFeatureCount = 1,
                                           .pEnabledValidationFeatures = &synchronization};
  const vk::InstanceCreateInfo info{.pNext = request.validation ? &features : nullptr,
                                    .pApplicationInfo = &application,
                                    .enabledLayerCount = uint32_t(layers.size()),
                                    .ppEnabledLayerNames = layers.data(),
                                    .enabledExtensionCount = uint32_t(extensions.size()),
                                    .ppEnabledExtensionNames = extensions.data()};
  try {
    made.instance = vk::raii::Instance(loader, info);
  } catch (const vk::IncompatibleDriverError&) {
    throw deviceError(
        "no Vulkan driver was found (on Debian: apt install mesa-vulkan-drivers, which renders in software; "
        "VK_DRIVER_FILES and VK_ICD_FILENAMES must name existing files where they are set)");
  } catch (const vk::SystemError& failure) {
    throw deviceError(fmt::format("no Vulkan instance could be made: {}", failure.what()));
  }
  if (request.validation) {
    made.messenger = guarded("validation messages",
                             [&] { return vk::raii::DebugUtilsMessengerEXT(made.instance, messenger); });
  }
  return made;
}

}  // namespace skitter::gpu

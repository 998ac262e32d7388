#include <cstring>
#include <string>

#include "bindings/c/handles.h"

using namespace skitter;
using c::given;
using c::guarded;

namespace {

thread_local std::string lastError;

template <size_t Size>
void copyText(const std::string& text, char (&to)[Size]) {
  const size_t length = std::min(text.size(), Size - 1);
  std::memcpy(to, text.data(), length);
  to[length] = '\0';
}

}  // namespace

void c::remember(const char* message) noexcept {
  try {
    lastError = message;
  } catch (...) {
    lastError.clear();
  }
}

const char* skitter_version() { return SKITTER_VERSION; }
const char* skitter_last_error() { return lastError.c_str(); }

skitter_result skitter_device_list(skitter_device_info* infos, uint32_t room, uint32_t* count) {
  return guarded([&] {
    given(count, "count");
    if (room > 0) given(infos, "infos");
    const std::vector<DeviceReport> all = listDevices();
    for (uint32_t i = 0; i < all.size() && i < room; ++i) {
      const DeviceReport& report = all[i];
      infos[i] = {};
      copyText(report.name, infos[i].name);
      copyText(report.typeName(), infos[i].type);
      copyText(report.whyNot, infos[i].why_not);
      infos[i].index = report.index;
      infos[i].suitable = report.suitable ? 1 : 0;
      infos[i].chosen = report.chosen ? 1 : 0;
    }
    *count = static_cast<uint32_t>(all.size());
  });
}

skitter_result skitter_device_create(const char* name, skitter_device** device) {
  return guarded([&] {
    given(device, "device");
    DeviceRequest request;
    if (name != nullptr) request.device = name;
    *device = new skitter_device{std::make_shared<Device>(Device::create(request))};
  });
}

skitter_result skitter_add_features(VkPhysicalDeviceFeatures2* chain, VkPhysicalDevice physical) {
  return guarded([&] {
    given(physical, "device");
    addFeatures(given(chain, "chain"), physical);
  });
}

skitter_result skitter_device_adopt(const skitter_adoption* from, skitter_device** device) {
  return guarded([&] {
    const skitter_adoption& parts = given(from, "from");
    given(device, "device");
    given(parts.instance, "from->instance");
    given(parts.physical_device, "from->physical_device");
    given(parts.device, "from->device");
    given(parts.queue, "from->queue");
    given(parts.features, "from->features");
    if (parts.extension_count > 0) given(parts.extensions, "from->extensions");
    AdoptedDevice adopted{.instance = parts.instance,
                          .physicalDevice = parts.physical_device,
                          .device = parts.device,
                          .queue = parts.queue,
                          .queueFamily = parts.queue_family,
                          .getInstanceProcAddr = parts.get_instance_proc_addr,
                          .features = parts.features,
                          .extensions = {parts.extensions, parts.extension_count},
                          .pipelineCache = parts.pipeline_cache};
    void* const user = parts.user;
    if (const auto lock = parts.lock_queue) adopted.lockQueue = [=] { lock(user); };
    if (const auto unlock = parts.unlock_queue) adopted.unlockQueue = [=] { unlock(user); };
    *device = new skitter_device{std::make_shared<Device>(Device::adopt(adopted))};
  });
}

skitter_result skitter_device_destroy(skitter_device* device) {
  return guarded([&] { delete device; });
}

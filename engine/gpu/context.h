#pragma once

#include "gpu/vulkan.h"
#include "skitter/device.h"
#include "skitter/error.h"

#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace skitter::gpu {

class Pipelines;
class Spares;

// The engine's view of a Device: the handles, and what everything made on it shares. Its address is stable,
// so what is made on it keeps a pointer to it.
//
// Commands are recorded through plain vk::CommandBuffer and the loader's own entry points; objects are
// vk::raii.
class Context {
 public:
  struct Parts {
    std::shared_ptr<ValidationLog> log;  // first, so that it hears the others go
    vk::raii::Context loader;
    vk::raii::Instance instance = nullptr;
    vk::raii::DebugUtilsMessengerEXT messenger = nullptr;
    vk::raii::PhysicalDevice physical = nullptr;
    vk::raii::Device device = nullptr;
    vk::raii::Queue queue = nullptr;
    uint32_t queueFamily = 0;
    bool debugUtils = false;  // VK_EXT_debug_utils is enabled
    DeviceReport report;
    bool adopted = false;
    std::function<void()> lockQueue = {}, unlockQueue = {};
    vk::PipelineCache hostsCache = {};
    std::vector<uint8_t> pipelineCache = {};  // to begin with
  };
  explicit Context(Parts);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const vk::raii::Instance& instance() const { return parts_.instance; }
  const vk::raii::PhysicalDevice& physical() const { return parts_.physical; }
  const vk::raii::Device& device() const { return parts_.device; }
  // The queue, kept from the host's other threads for as long as this lives: the end of a statement.
  class LockedQueue {
   public:
    explicit LockedQueue(const Parts& parts) : parts_(parts) {
      if (parts_.lockQueue) parts_.lockQueue();
    }
    ~LockedQueue() {
      if (parts_.unlockQueue) parts_.unlockQueue();
    }
    LockedQueue(const LockedQueue&) = delete;
    LockedQueue& operator=(const LockedQueue&) = delete;
    const vk::raii::Queue* operator->() const { return &parts_.queue; }

   private:
    const Parts& parts_;
  };
  LockedQueue queue() const { return LockedQueue(parts_); }
  vk::Queue queueHandle() const { return *parts_.queue; }
  uint32_t queueFamily() const { return parts_.queueFamily; }

  const DeviceReport& report() const { return parts_.report; }
  const DeviceLimits& limits() const { return parts_.report.limits; }
  const DeviceFeatures& features() const { return parts_.report.features; }
  bool isCpu() const { return parts_.report.type == VK_PHYSICAL_DEVICE_TYPE_CPU; }
  const std::shared_ptr<ValidationLog>& validationLog() const { return parts_.log; }

  // LOAD4 goes through texel buffers rather than storage buffers.
  bool texelLoads() const { return parts_.report.loads.path == LoadPath::texel; }
  // What was made before keeps to the path of its time.
  void setLoads(LoadChoice choice) { parts_.report.loads = std::move(choice); }
  // STORE4 writes by 64 bits, where LOAD4 goes through texel buffers.
  bool wideStores() const { return parts_.report.stores.width == StoreWidth::bits64; }
  void setStores(StoreChoice choice) { parts_.report.stores = std::move(choice); }
  bool timestamps() const { return limits().timestampBits != 0; }
  bool draws() const { return features().graphics; }

  // Kernels and graphics pipelines that are new all go through it.
  const vk::raii::PipelineCache& pipelineCache() const { return pipelineCache_; }
  // Those that were made before.
  Pipelines& pipelines() const { return *pipelines_; }
  // For copies between host and device.
  Spares& spares() const { return *spares_; }
  // Nearest, clamped to the edge: what heightfields are read with.
  vk::Sampler nearestSampler() const { return *nearestSampler_; }

  // Allocates for a resource: `wanted` is necessary, `preferred` is taken where there is a type that has it.
  // Throws Error(device) naming `what` and its size when there is no such memory or not enough of it.
  vk::raii::DeviceMemory allocate(const vk::MemoryRequirements&, vk::MemoryPropertyFlags wanted,
                                  vk::MemoryPropertyFlags preferred, const std::string& what) const;

  // A name for debuggers and validation messages; without VK_EXT_debug_utils nothing happens.
  template <class Handle>
  void name(Handle handle, const std::string& text) const {
    setName(Handle::objectType, (uint64_t)(typename Handle::CType)handle, text);
  }

  void beginLabel(vk::CommandBuffer, const char* text) const;
  void endLabel(vk::CommandBuffer) const;

  // For what was submitted; on an adopted device, to its queue.
  void waitIdle() const;

 private:
  void setName(vk::ObjectType, uint64_t handle, const std::string& text) const;

  Parts parts_;
  vk::raii::PipelineCache pipelineCache_ = nullptr;
  std::unique_ptr<Pipelines> pipelines_;
  vk::raii::Sampler nearestSampler_ = nullptr;
  std::unique_ptr<Spares> spares_;
};

// Runs `call`, and turns a Vulkan failure into an Error(device) that reads "<doing>: <the failure>".
template <class Call>
decltype(auto) guarded(std::string_view doing, Call&& call) {
  try {
    return std::forward<Call>(call)();
  } catch (const vk::SystemError& failure) {
    throw deviceError(std::string(doing) + ": " + failure.what());
  }
}

}  // namespace skitter::gpu

#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skitter/error.h"
#include "skitter/export.h"

namespace skitter {

namespace gpu {
class Context;
}

// How shaders read records, and write them (shaders/lib/load4.glsl).
enum class LoadPath {
  texel,    // RGBA32F texel buffers (needs shaderInt64, for what may be written by 64 bits)
  storage,  // storage buffers
};

// Nanoseconds that reading a vec4 takes, records of four read as stages do: of a software device's CPU time,
// of another's own time, in which many are read at once.
struct LoadCost {
  double texel = 0, storage = 0;
};

// Storage buffers, unless texel buffers are measured to be quicker by a margin that noise cannot make up for.
struct LoadChoice {
  LoadPath path = LoadPath::storage;
  std::optional<LoadCost> cost = {};  // where both paths were measured
  std::string why = {};               // for people
};

// Bits of the numbers in which records that are read through texel buffers are written. A software device
// stores number by number and lane by lane: half as many are quicker where taking one out of a register is.
enum class StoreWidth { bits32, bits64 };

// Nanoseconds that writing a vec4 takes, two in a row, as LoadCost tells them.
struct StoreCost {
  double bits32 = 0, bits64 = 0;
};

// Whichever is measured to be quicker; both write the same bits.
struct StoreChoice {
  StoreWidth width = StoreWidth::bits32;
  std::optional<StoreCost> cost = {};  // where both were measured
  std::string why = {};                // for people
};

struct DeviceLimits {
  uint32_t subgroupSize = 0;
  uint64_t maxStorageBufferRange = 0;   // bytes that one storage buffer binding reaches
  uint64_t maxTexelBufferElements = 0;  // vec4 that one texel buffer view reaches
  uint64_t minTexelBufferOffsetAlignment = 0;
  uint64_t minStorageBufferOffsetAlignment = 0;
  uint64_t minUniformBufferOffsetAlignment = 0;
  uint64_t maxAllocationBytes = 0;  // in one buffer or image
  uint32_t maxImageDimension2D = 0;
  uint32_t maxComputeWorkGroupInvocations = 0;
  uint32_t maxComputeWorkGroupCountX = 0;
  uint32_t maxPushConstantsSize = 0;
  uint64_t heapBytes = 0;  // the largest device-local heap, as reported (lavapipe says 2 GiB and gives more)
  uint64_t availableBytes = 0;  // what can be allocated now: free RAM on a CPU device (the machine's, or less
                                // where a control group limits it), the memory budget where the driver tells
                                // it, the heap otherwise
  std::string availableOf = {};  // which of these, for people: "machine", "cgroup /sys/fs/cgroup"
  double timestampPeriod = 0;    // nanoseconds a timestamp tick
  uint32_t timestampBits = 0;    // of a timestamp that count; 0 where the queue has none
  bool texelRgba32f = false;     // R32G32B32A32_SFLOAT uniform texel buffers
  bool sampledR32f = false;      // R32_SFLOAT sampled images: heightfields need them
};

// Optional features. Those present are enabled on a device that create() makes; of an adopted device, those
// are true that its maker says are enabled.
struct DeviceFeatures {
  bool graphics = false;  // the queue draws: without it there is no Renderer
  bool drawIndirectCount = false;
  bool multiDrawIndirect = false;
  bool drawIndirectFirstInstance = false;
  bool shaderDrawParameters = false;
  bool fillModeNonSolid = false;  // wireframe overlays
  bool samplerAnisotropy = false;
  bool shaderInt64 = false;   // without it records are not read through texel buffers
  bool presentation = false;  // VK_KHR_swapchain
};

struct SKITTER_API DeviceReport {
  std::string name;
  std::string driver;  // name and version as the driver tells them
  uint32_t index = 0;  // the number that DeviceRequest::device accepts
  VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
  uint32_t apiVersion = 0;
  DeviceLimits limits;
  DeviceFeatures features;
  std::vector<std::string> lacks;  // optional features and sizes that it is without, as `info` names them
  LoadChoice loads;                // of a Device; listDevices() opens none and measures nothing
  StoreChoice stores;              // likewise
  bool suitable = false;
  std::vector<std::string> refusals;  // each reason why it is not suitable
  bool chosen = false;
  std::string whyNot;  // for a device not chosen: its refusals, or what outranked it

  const char* typeName() const;  // "discrete", "integrated", "virtual", "cpu", "other"
};

struct DeviceRequest {
  // INDEX, or part of the NAME in any case; the best suitable device where there is none.
  std::optional<std::string> device = {};
  // Validation layer with synchronization validation, into validationLog().
  bool validation = false;
  // A swapchain will be made, for which the window system needs these instance extensions.
  bool presentation = false;
  std::vector<std::string> instanceExtensions = {};
  // Read records so and measure nothing; without it, SKITTER_LOADS may name "texel" or "storage".
  std::optional<LoadPath> loads = {};
  // Likewise; SKITTER_STORES may name "32" or "64".
  std::optional<StoreWidth> stores = {};
  // The bytes that Device::pipelineCacheData() gave in an earlier run; read while the device is made. What
  // another device or driver wrote is passed over.
  std::vector<uint8_t> pipelineCache = {};
};

// The features that a device must be made with, and those with which the engine is quicker: chains of
// VkPhysicalDeviceVulkan11Features, VkPhysicalDeviceVulkan12Features and VkPhysicalDeviceVulkan13Features,
// which live as long as the program.
SKITTER_API const VkPhysicalDeviceFeatures2& requiredFeatures();
SKITTER_API const VkPhysicalDeviceFeatures2& recommendedFeatures();
// Names of device extensions.
SKITTER_API std::span<const char* const> requiredExtensions();
SKITTER_API std::span<const char* const> recommendedExtensions();
// Switches on in the caller's chain, before vkCreateDevice, what is required and, of what is recommended,
// what the device has. Whatever is on stays on. Throws Error(input) naming a required feature for which the
// chain has no structure.
SKITTER_API void addFeatures(VkPhysicalDeviceFeatures2& chain, VkPhysicalDevice);

// A device that the caller made, as Device::adopt takes it. What is pointed to is read during the call.
struct AdoptedDevice {
  // From the Vulkan loader, as those of GLFW, SDL and volk are. The instance was made for Vulkan 1.3.
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  // Computes; a Renderer also needs graphics.
  VkQueue queue = VK_NULL_HANDLE;
  uint32_t queueFamily = 0;
  PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;  // null: the loader's
  // The features that were enabled: the chain that vkCreateDevice was given (VkDeviceCreateInfo::pNext, with
  // pEnabledFeatures, if any, in its `features`), and the extensions of instance and device.
  const VkPhysicalDeviceFeatures2* features = nullptr;
  std::span<const char* const> extensions = {};
  // Called about each use of the queue by the engine, from the thread that called the engine: both or
  // neither. They must not throw. Without them the caller's threads keep their uses of the queue apart from
  // calls of the engine.
  std::function<void()> lockQueue = {}, unlockQueue = {};
  VkPipelineCache pipelineCache =
      VK_NULL_HANDLE;  // the engine's pipelines go through it; null: one of the engine's own
  // As those of DeviceRequest.
  std::optional<LoadPath> loads = {};
  std::optional<StoreWidth> stores = {};
};

struct ValidationMessage {
  std::string id;  // the VUID or the SYNC- name
  std::string text;
  uint32_t count = 0;  // how often exactly this text came
};

// Messages of the validation layer, warnings and errors. It may outlive its device, so that complaints about
// the device's own destruction can still be read. Thread-safe.
class SKITTER_API ValidationLog {
 public:
  std::vector<ValidationMessage> messages() const;
  void clear();
  void add(std::string id, std::string text);

 private:
  mutable std::mutex mutex_;
  std::vector<ValidationMessage> messages_;
};

// Every device of this machine, suitable or not, in Vulkan's order, with the choice that create() would make.
// Throws Error(device) when there is no Vulkan driver at all.
SKITTER_API std::vector<DeviceReport> listDevices(const DeviceRequest& = {});

// One Vulkan device with one queue that does compute, transfer and, but for some that are adopted, graphics.
// Everything made on it must be gone before it is destroyed. Work is submitted from one thread at a time.
class SKITTER_API Device {
 public:
  // The best suitable device: Vulkan 1.3, a graphics and compute queue, requiredFeatures(); discrete before
  // integrated before virtual before cpu. Throws Error(device) listing each candidate with its reasons. Takes
  // some milliseconds to find out how records are best read and written.
  static Device create(const DeviceRequest& = {});

  // A device that the caller made and keeps: no handle is ever destroyed here, and all outlive the Device.
  // How records are best read and written is measured as create() does it, by submissions to the queue.
  // Throws Error(device) that names everything that is missing, before anything is made. docs/embedding.md
  // tells who waits for what.
  static Device adopt(const AdoptedDevice&);

  Device(Device&&) noexcept;
  Device& operator=(Device&&) noexcept;
  ~Device();

  const DeviceReport& report() const;
  VkDevice handle() const;
  VkInstance instance() const;
  VkPhysicalDevice physicalDevice() const;
  VkQueue queue() const;
  uint32_t queueFamily() const;

  // Waits for what was submitted: to a device of create() at all, to the queue of an adopted one. Throws
  // Error(device) when the device is lost.
  void waitIdle() const;

  // Records into a command buffer, submits it and waits: for set-up, tools and first steps, where nothing
  // else is to go on meanwhile. Throws Error(device) when the device is lost, Error(input)
  // without a function.
  void run(const std::function<void(VkCommandBuffer)>& record) const;

  // For DeviceRequest::pipelineCache in the next run: the pipelines made so far, and the host's where it gave
  // a cache.
  std::vector<uint8_t> pipelineCacheData() const;

  // Empty unless the request asked for validation.
  std::vector<ValidationMessage> validationMessages() const;
  std::shared_ptr<ValidationLog> validationLog() const;

  // The engine's own view (engine/gpu/context.h); of no use outside it.
  gpu::Context& context() const { return *context_; }

 private:
  explicit Device(std::unique_ptr<gpu::Context>);
  std::unique_ptr<gpu::Context> context_;
};

}  // namespace skitter

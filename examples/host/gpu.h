// The host's own Vulkan: instance, device, queues, memory, pipelines. Plain calls, no error recovery: a
// program with a renderer has all of this already, and Skitter takes it as it is.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

// Throws std::runtime_error that names the call.
#define VK_CHECK(call) host::check(call, #call)

namespace host {

void check(VkResult result, const char* call);

struct Queue {
  uint32_t family = 0;
  VkQueue queue = VK_NULL_HANDLE;
};

struct Buffer {
  VkBuffer handle = VK_NULL_HANDLE;
  VkDeviceSize bytes = 0;
  void* mapped = nullptr;  // host-visible ones
};

struct Image {
  VkImage handle = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkExtent2D extent{};
};

// A pipeline whose set 0 has `storageBuffers` of them, and push constants.
struct Pipeline {
  VkPipelineBindPoint point = VK_PIPELINE_BIND_POINT_COMPUTE;
  VkShaderStageFlags stages = 0;
  VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipeline handle = VK_NULL_HANDLE;
  uint32_t storageBuffers = 0;
};

struct VertexAttribute {
  VkFormat format;
  uint32_t offset;
};

class Gpu {
 public:
  // `validate`: with the validation layer and its synchronization checks, which messages() counts.
  Gpu(const std::vector<const char*>& instanceExtensions, bool validate);
  ~Gpu();
  Gpu(const Gpu&) = delete;
  Gpu& operator=(const Gpu&) = delete;

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  // As the device was made with, for Skitter to be told.
  VkPhysicalDeviceFeatures2 features{};
  std::vector<const char*> extensions;
  // The crowd walks on `compute`: a queue of its own where the device has another one, else the same.
  Queue graphics, compute;
  uint32_t messages() const { return messages_; }

  // Both queues may use them, without a transfer of ownership.
  Buffer makeBuffer(VkDeviceSize bytes, VkBufferUsageFlags usage, bool hostVisible = false);
  template <class T>
  Buffer makeBuffer(const std::vector<T>& data, VkBufferUsageFlags usage) {
    return upload(std::as_bytes(std::span(data)), usage);
  }
  Image makeImage(VkExtent2D extent, VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect);
  void destroy(const Image& image);

  Pipeline makeCompute(std::span<const uint32_t> code, uint32_t storageBuffers, uint32_t pushBytes);
  struct Drawing {
    std::span<const uint32_t> vertex, fragment;
    uint32_t storageBuffers = 0, pushBytes = 0;
    uint32_t vertexStride = 0;
    std::vector<VertexAttribute> attributes = {};
    VkFormat colour, depth;
  };
  Pipeline makeDrawing(const Drawing& drawing);
  VkDescriptorSet bind(const Pipeline& pipeline, const std::vector<VkBuffer>& buffers);

  VkCommandPool makePool(uint32_t family);
  VkCommandBuffer makeCommands(VkCommandPool pool);
  VkSemaphore makeTimeline();
  VkSemaphore makeSemaphore();

 private:
  VkPhysicalDeviceVulkan12Features features12_{};
  VkPhysicalDeviceVulkan13Features features13_{};
  Buffer upload(std::span<const std::byte> bytes, VkBufferUsageFlags usage);
  VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted);
  VkShaderModule module(std::span<const uint32_t> code);
  Pipeline makeLayout(VkPipelineBindPoint point, VkShaderStageFlags stages, uint32_t storageBuffers,
                      uint32_t pushBytes);

  static VKAPI_ATTR VkBool32 VKAPI_CALL say(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                            VkDebugUtilsMessageTypeFlagsEXT,
                                            const VkDebugUtilsMessengerCallbackDataEXT*, void*);

  uint32_t messages_ = 0;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkDescriptorPool sets_ = VK_NULL_HANDLE;
  // What goes with the device.
  std::vector<VkDeviceMemory> memory_;
  std::vector<VkBuffer> buffers_;
  std::vector<Image> images_;
  std::vector<Pipeline> pipelines_;
  std::vector<VkCommandPool> pools_;
  std::vector<VkSemaphore> semaphores_;
};

// Between two uses of memory on one queue.
void barrier(VkCommandBuffer cmd, VkPipelineStageFlags2 from, VkAccessFlags2 written,
             VkPipelineStageFlags2 to, VkAccessFlags2 access);
// An image from one use to another.
void transition(VkCommandBuffer cmd, VkImage image, VkImageAspectFlags aspect, VkImageLayout before,
                VkImageLayout after, VkPipelineStageFlags2 from, VkAccessFlags2 written,
                VkPipelineStageFlags2 to, VkAccessFlags2 access);

template <class T>
void use(VkCommandBuffer cmd, const Pipeline& pipeline, VkDescriptorSet set, const T& push) {
  vkCmdBindPipeline(cmd, pipeline.point, pipeline.handle);
  vkCmdBindDescriptorSets(cmd, pipeline.point, pipeline.layout, 0, 1, &set, 0, nullptr);
  vkCmdPushConstants(cmd, pipeline.layout, pipeline.stages, 0, sizeof push, &push);
}

}  // namespace host

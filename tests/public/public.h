// Tests that see the public headers alone share this.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <vulkan/vulkan.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "skitter/crowd.h"
#include "skitter/device.h"
#include "skitter/error.h"
#include "skitter/scene.h"

namespace skitter::test {

inline constexpr float tickSeconds = 1.0f / 60;

// The call throws an Error of that kind, whose message has the text.
template <class Call>
void expectError(Error::Kind kind, const std::string& text, const Call& call) {
  try {
    call();
    ADD_FAILURE() << "nothing was refused, expected: " << text;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_THAT(error.what(), testing::HasSubstr(text));
  } catch (const std::exception& other) {
    ADD_FAILURE() << "expected an Error, found another exception: " << other.what();
  }
}
template <class Call>
void expectRefused(const std::string& text, const Call& call) {
  expectError(Error::Kind::input, text, call);
}

// A folder of the test's own, gone with everything in it at the end.
class OwnFolder {
 public:
  OwnFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "skitter_public_XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~OwnFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  // A file of that content.
  std::filesystem::path with(const std::string& name, const std::string& content) const {
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

inline std::filesystem::path assetFile(const std::string& name) {
  return std::filesystem::path(SKITTER_ASSETS) / name;
}

inline DeviceRequest publicRequest() {
  DeviceRequest request{.validation = true};
  if (const char* selector = std::getenv("SKITTER_TEST_DEVICE")) request.device = selector;
  return request;
}

// A device with the validation layer, each of whose messages fails the test.
class PublicTest : public testing::Test {
 protected:
  void SetUp() override {
    device_ = std::make_unique<Device>(Device::create(publicRequest()));
    log_ = device_->validationLog();
  }
  void TearDown() override {
    device_.reset();
    if (!log_) return;
    for (const ValidationMessage& message : log_->messages()) ADD_FAILURE() << message.text;
  }
  Device& device() { return *device_; }

 private:
  std::shared_ptr<ValidationLog> log_;
  std::unique_ptr<Device> device_;
};

// 32 m a side.
inline Heightfield flatGround() { return generateHeightfield({.columns = 65, .rows = 65, .amplitude = 0}); }

// So many who stand on a grid about the middle and look along +z.
inline Scene standingScene(uint32_t agents, uint32_t reserve = 0) {
  Scene scene;
  scene.name = "standing";
  scene.herds[0].agents = agents;
  scene.herds[0].reserve = reserve;
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 3};
  scene.herds[0].goal = {.kind = Goal::Kind::none};
  return scene;
}

inline void walk(const Device& device, Crowd& crowd, int ticks) {
  for (int i = 0; i < ticks; ++i)
    device.run([&](VkCommandBuffer commands) { crowd.record(commands, tickSeconds); });
}

// A buffer of the caller's own, which the host sees, made by plain Vulkan calls.
class OwnBuffer {
 public:
  OwnBuffer(const Device& device, VkDeviceSize bytes) : device_(device.handle()), bytes_(bytes) {
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    EXPECT_EQ(vkCreateBuffer(device_, &info, nullptr, &buffer_), VK_SUCCESS);
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device_, buffer_, &needs);
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(device.physicalDevice(), &memory);
    constexpr VkMemoryPropertyFlags wanted =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkMemoryAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocation.allocationSize = needs.size;
    while ((needs.memoryTypeBits >> allocation.memoryTypeIndex & 1) == 0 ||
           (memory.memoryTypes[allocation.memoryTypeIndex].propertyFlags & wanted) != wanted)
      ++allocation.memoryTypeIndex;
    EXPECT_EQ(vkAllocateMemory(device_, &allocation, nullptr, &memory_), VK_SUCCESS);
    EXPECT_EQ(vkBindBufferMemory(device_, buffer_, memory_, 0), VK_SUCCESS);
    void* mapped = nullptr;
    EXPECT_EQ(vkMapMemory(device_, memory_, 0, VK_WHOLE_SIZE, 0, &mapped), VK_SUCCESS);
    floats_ = static_cast<float*>(mapped);
    std::fill_n(floats_, bytes / sizeof(float), 0.0f);
  }
  ~OwnBuffer() {
    vkDestroyBuffer(device_, buffer_, nullptr);
    vkFreeMemory(device_, memory_, nullptr);
  }
  OwnBuffer(const OwnBuffer&) = delete;
  OwnBuffer& operator=(const OwnBuffer&) = delete;

  VkBuffer handle() const { return buffer_; }
  VkDeviceSize bytes() const { return bytes_; }
  // The numbers that the device has written, once it was waited for.
  float* floats() const { return floats_; }
  // Copies another's bytes into this one, after all that the command buffer has done, for the host to read.
  void copyFrom(VkCommandBuffer commands, VkBuffer from, VkDeviceSize offset = 0) const {
    const VkBufferCopy region{.srcOffset = offset, .dstOffset = 0, .size = bytes_};
    vkCmdCopyBuffer(commands, from, buffer_, 1, &region);
    toHost(commands);
  }
  static void toHost(VkCommandBuffer commands) {
    VkMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
  }

 private:
  VkDevice device_;
  VkDeviceSize bytes_;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  float* floats_ = nullptr;
};

}  // namespace skitter::test

// The type and the heap that are chosen of a device's memory.
#include "gpu/device_memory.h"

#include <gtest/gtest.h>

namespace skitter::gpu {
namespace {

// A GPU with a window into its memory has these.
vk::PhysicalDeviceMemoryProperties properties() {
  using Flag = vk::MemoryPropertyFlagBits;
  vk::PhysicalDeviceMemoryProperties memory;
  for (const vk::MemoryPropertyFlags flags :
       {vk::MemoryPropertyFlags(Flag::eDeviceLocal), Flag::eHostVisible | Flag::eHostCoherent,
        Flag::eHostVisible | Flag::eHostCoherent | Flag::eHostCached,
        Flag::eDeviceLocal | Flag::eHostVisible | Flag::eHostCoherent})
    memory.memoryTypes[memory.memoryTypeCount++].propertyFlags = flags;
  memory.memoryHeaps[memory.memoryHeapCount++] = vk::MemoryHeap{1000, vk::MemoryHeapFlagBits::eDeviceLocal};
  memory.memoryHeaps[memory.memoryHeapCount++] = vk::MemoryHeap{9000, {}};
  memory.memoryHeaps[memory.memoryHeapCount++] = vk::MemoryHeap{200, vk::MemoryHeapFlagBits::eDeviceLocal};
  return memory;
}

TEST(DeviceMemory, TheTypeIsAllowedAndHasEveryFlag) {
  using Flag = vk::MemoryPropertyFlagBits;
  const auto visible = Flag::eHostVisible | Flag::eHostCoherent;
  EXPECT_EQ(memoryTypeOf(properties(), 15, Flag::eDeviceLocal), 0u);
  EXPECT_EQ(memoryTypeOf(properties(), 14, Flag::eDeviceLocal), 3u);
  EXPECT_EQ(memoryTypeOf(properties(), 15, visible), 1u);
  EXPECT_EQ(memoryTypeOf(properties(), 13, visible), 2u);
  EXPECT_EQ(memoryTypeOf(properties(), 15, visible | Flag::eDeviceLocal), 3u);
  EXPECT_EQ(memoryTypeOf(properties(), 15, visible | Flag::eHostCached), 2u);
  EXPECT_FALSE(memoryTypeOf(properties(), 7, visible | Flag::eDeviceLocal));
  EXPECT_FALSE(memoryTypeOf(properties(), 0, {}));
  EXPECT_FALSE(memoryTypeOf(properties(), 0xfffffff0, Flag::eDeviceLocal));  // of types that there are not
}

TEST(DeviceMemory, TheLargestHeapIsTheDevicesOwn) {
  EXPECT_EQ(largestDeviceHeap(properties()), 1000u);
  EXPECT_EQ(largestDeviceHeap({}), 0u);
}

}  // namespace
}  // namespace skitter::gpu

// A program of somebody else's steers a crowd by a compute shader of its own: nothing but public headers and
// Vulkan.
#include <gtest/gtest.h>
#include <vulkan/vulkan.h>

// What is not named is 0, which is what Vulkan wants.
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"

#include <array>
#include <cmath>

#include "embedded/wind_comp.h"
#include "skitter/crowd.h"

namespace {

using namespace skitter;

struct Run {
  uint32_t first, agents;
  float windX, windZ;
};

// The shader's pipeline, with a set for one buffer.
class Wind {
 public:
  explicit Wind(VkDevice device) : device_(device) {
    const auto code = embedded::wind_comp();
    const VkShaderModuleCreateInfo module{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                          .codeSize = code.size(),
                                          .pCode = reinterpret_cast<const uint32_t*>(code.data())};
    vkCreateShaderModule(device, &module, nullptr, &module_);
    const VkDescriptorSetLayoutBinding binding{.binding = 0,
                                               .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                               .descriptorCount = 1,
                                               .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
    const VkDescriptorSetLayoutCreateInfo set{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                              .bindingCount = 1,
                                              .pBindings = &binding};
    vkCreateDescriptorSetLayout(device, &set, nullptr, &setLayout_);
    const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(Run)};
    const VkPipelineLayoutCreateInfo layout{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                            .setLayoutCount = 1,
                                            .pSetLayouts = &setLayout_,
                                            .pushConstantRangeCount = 1,
                                            .pPushConstantRanges = &push};
    vkCreatePipelineLayout(device, &layout, nullptr, &layout_);
    const VkComputePipelineCreateInfo pipeline{
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module_,
                  .pName = "main"},
        .layout = layout_};
    vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &pipeline, nullptr, &pipeline_);
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 8};
    const VkDescriptorPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                          .maxSets = 8,
                                          .poolSizeCount = 1,
                                          .pPoolSizes = &size};
    vkCreateDescriptorPool(device, &pool, nullptr, &pool_);
  }
  ~Wind() {
    vkDestroyDescriptorPool(device_, pool_, nullptr);
    vkDestroyPipeline(device_, pipeline_, nullptr);
    vkDestroyPipelineLayout(device_, layout_, nullptr);
    vkDestroyDescriptorSetLayout(device_, setLayout_, nullptr);
    vkDestroyShaderModule(device_, module_, nullptr);
  }

  VkDescriptorSet bind(VkBuffer goals) const {
    const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                           .descriptorPool = pool_,
                                           .descriptorSetCount = 1,
                                           .pSetLayouts = &setLayout_};
    VkDescriptorSet set = VK_NULL_HANDLE;
    vkAllocateDescriptorSets(device_, &info, &set);
    const VkDescriptorBufferInfo buffer{goals, 0, VK_WHOLE_SIZE};
    const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                     .dstSet = set,
                                     .dstBinding = 0,
                                     .descriptorCount = 1,
                                     .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                     .pBufferInfo = &buffer};
    vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
    return set;
  }

  // After the barrier that docs/steering.md asks for.
  void record(VkCommandBuffer commands, VkDescriptorSet set, const Run& run) const {
    const VkMemoryBarrier2 barrier{
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
        .srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
        .dstAccessMask = VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
    const VkDependencyInfo dependency{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(commands, &dependency);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set, 0, nullptr);
    vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof run, &run);
    vkCmdDispatch(commands, (run.agents + 127) / 128, 1, 1);
  }

 private:
  VkDevice device_;
  VkShaderModule module_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
};

TEST(OwnShader, SteersOneOfTwoHerdsThatShareTheirPages) {
  Device device = Device::create({.validation = true});
  Scene scene = builtinScene();
  scene.herds[0].agents = 30;
  scene.herds[0].goal.kind = Goal::Kind::none;
  scene.herds.push_back(scene.herds[0]);
  {
    Crowd crowd(device, scene.loadTerrain(), scene, CrowdOptions{.pageAgents = 16});
    const Wind wind(device.handle());
    std::vector<GoalBuffer> buffers = crowd.goalBuffers(1);
    std::vector<VkDescriptorSet> sets;
    uint32_t agents = 0;
    for (const GoalBuffer& buffer : buffers) {
      EXPECT_EQ(buffer.firstAgent, agents);
      agents += buffer.agents;
      sets.push_back(wind.bind(buffer.goals));
    }
    EXPECT_EQ(agents, 30u);
    EXPECT_EQ(buffers.size(), 3u);

    const VkCommandPoolCreateInfo poolInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                           .queueFamilyIndex = device.queueFamily()};
    VkCommandPool pool = VK_NULL_HANDLE;
    vkCreateCommandPool(device.handle(), &poolInfo, nullptr, &pool);
    const VkCommandBufferAllocateInfo allocation{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                 .commandPool = pool,
                                                 .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                 .commandBufferCount = 1};
    VkCommandBuffer commands = VK_NULL_HANDLE;
    vkAllocateCommandBuffers(device.handle(), &allocation, &commands);
    for (int batch = 0; batch < 10; ++batch) {
      const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                           .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
      vkBeginCommandBuffer(commands, &begin);
      for (int tick = 0; tick < 20; ++tick) {
        for (size_t i = 0; i < sets.size(); ++i)
          wind.record(commands, sets[i], {buffers[i].first, buffers[i].agents, 3, 0});
        // The host has the last word.
        if (batch == 9) crowd.steer(std::array{AgentGoal{crowd.agentId(1, 7), {.kind = Goal::Kind::none}}});
        crowd.record(commands, 1.0f / 60);
      }
      vkEndCommandBuffer(commands);
      const VkSubmitInfo submit{
          .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands};
      vkQueueSubmit(device.queue(), 1, &submit, VK_NULL_HANDLE);
      device.waitIdle();
      vkResetCommandPool(device.handle(), pool, 0);
    }
    for (uint32_t herd = 0; herd < 2; ++herd) {
      const HerdState state = crowd.download(herd);
      for (size_t i = 0; i < 30; ++i) {
        const float speed = herd == 0 || i == 7 ? 0.0f : 2.0f;  // wind is cut to 2 m/s
        EXPECT_NEAR(state.steer[4 * i], speed, 1e-5f) << herd << ", " << i;
        EXPECT_EQ(state.steer[4 * i + 1], 0) << herd << ", " << i;
      }
    }
    vkDestroyCommandPool(device.handle(), pool, nullptr);
  }
  for (const ValidationMessage& message : device.validationMessages()) ADD_FAILURE() << message.text;
}

}  // namespace

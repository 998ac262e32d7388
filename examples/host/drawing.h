// What the host draws: the ground and every herd, by its own culling and its own shaders.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "gpu.h"
#include "skitter/crowd.h"
#include "skitter/device.h"
#include "skitter/palettes.h"

namespace host {

// All positions are relative to `origin`, a point of the world near the eye.
struct View {
  glm::dvec3 origin{0};
  glm::mat4 clip{1};
  glm::vec3 eye{0};
  float pixelsAway = 1;  // pixels of a metre, a metre away
};

constexpr uint32_t framesInFlight = 2;
constexpr VkFormat colourFormat = VK_FORMAT_R8G8B8A8_UNORM, depthFormat = VK_FORMAT_D32_SFLOAT;

class Drawing {
 public:
  Drawing(Gpu& gpu, skitter::Device& device, const skitter::Crowd& crowd, VkExtent2D extent);

  // After the crowd's tick, on its queue: what frames with that slot read.
  void recordPalettes(VkCommandBuffer cmd, const glm::dvec3& origin, uint32_t slot) const;
  // On the graphics queue. The picture ends in colour(), ready to be copied from.
  void record(VkCommandBuffer cmd, const View& view, uint32_t slot) const;

  const Image& colour() const { return colour_; }
  // An agent that is drawn in a colour of its own.
  void mark(uint32_t herd, uint32_t agent) { markedHerd_ = herd, marked_ = agent; }

 private:
  struct Slot {
    Buffer palettes, instances, visible, draws;
    VkDescriptorSet cull = VK_NULL_HANDLE, draw = VK_NULL_HANDLE;
  };
  struct Herd {
    uint32_t agents = 0, entries = 0;
    float radius = 0;
    Buffer vertices, indices;
    std::vector<VkDrawIndexedIndirectCommand> levels;  // nobody drawn yet
    glm::vec4 pixels{0};
    std::vector<Slot> slots;
    std::unique_ptr<skitter::Palettes> palettes;
  };
  Herd makeHerd(Gpu& gpu, skitter::Device& device, const skitter::Crowd& crowd, uint32_t herd) const;
  void cull(VkCommandBuffer cmd, const View& view, uint32_t slot) const;
  void drawGround(VkCommandBuffer cmd, const View& view) const;
  void drawHerds(VkCommandBuffer cmd, const View& view, uint32_t slot) const;

  const skitter::Heightfield& ground_;
  Image colour_, depth_;
  Pipeline cullPipeline_, agentPipeline_, groundPipeline_;
  VkDescriptorSet groundSet_ = VK_NULL_HANDLE;
  std::vector<Herd> herds_;
  uint32_t markedHerd_ = UINT32_MAX, marked_ = UINT32_MAX;
};

}  // namespace host

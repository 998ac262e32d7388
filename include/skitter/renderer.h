#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "skitter/crowd.h"
#include "skitter/device.h"
#include "skitter/export.h"
#include "skitter/scene.h"

namespace skitter {

// Where a picture is taken from. World metres; the projection is reversed-Z with an infinite far plane.
struct View {
  glm::vec3 eye{0, 4, -8};
  glm::vec3 target{0};
  float fieldOfView = 0.8f;  // radians, vertical
};

// The scene's camera at a time, any number of seconds. `follow` frames the action: one walker and those about
// it, seen from behind, aside and above, moving as the first herd that is there was commanded to at first.
// `orbit` turns about it, or about a point. `path` goes through its keys, and stays at the first before it
// and at the last after it. None of these is ever below the ground. Needs no readback. `crowd` was made of
// `scene`. Throws Error(input) for a path of keys that cannot be (Camera::keys).
SKITTER_API View viewOf(const Scene& scene, const Crowd& crowd, double seconds);

// What a picture consists of.
struct PictureCounts {
  uint64_t agents = 0;     // in the camera's sight
  uint64_t splats = 0;     // of these, agents that are drawn without triangles
  uint64_t triangles = 0;  // of the others, of the ground and of obstacles, without shadows
  uint64_t hidden = 0;     // in sight, but left out (RendererOptions::occlusion)
};

// How a renderer draws.
struct RendererOptions {
  // Agents are drawn as finely as if they were so many times larger on the screen, leastDetail to mostDetail.
  // Less is cheaper; the most leaves no level of detail out and draws nobody without triangles.
  float detail = 1;
  static constexpr float leastDetail = 0.25f, mostDetail = 100000;
  // Pixels that are shaded along each side of the picture, as a share of those that it has, leastScale to 1.
  // With less than 1 the picture is enlarged from fewer pixels, whose number then also decides on detail.
  float scale = 1;
  static constexpr float leastScale = 0.25f;
  // Feet of adaptive herds leave prints on the ground, which fade within 20 seconds: those that lift between
  // two of the renderer's pictures.
  bool footprints = false;
  // Agents in the camera's sight whom others or the ground hide are left out. It changes no picture. Unless
  // it is said, it is on where it pays: on GPUs, for crowds of at least occlusionAgents when the renderer is
  // made.
  std::optional<bool> occlusion = {};
  static constexpr uint64_t occlusionAgents = 200000;

  bool operator==(const RendererOptions&) const = default;
};

// Draws a crowd and its terrain into an image of its own. Reads the crowd's buffers where they lie.
class SKITTER_API Renderer {
 public:
  // Whether crowds of the scene need CrowdOptions::pose to be drawn. Herds that only play clips, those of
  // controller `clip`, do not: a renderer poses whom it shows, and the crowd keeps no poses of them.
  static bool needsPoses(const Scene& scene);

  // Throws Error(input) for a picture without pixels, a crowd without poses that needs them or other options,
  // Error(device) for a device whose queue has no graphics, when width or height exceed the device's limits
  // or memory does not suffice. The crowd outlives the renderer and stays where it is.
  Renderer(Device& device, const Crowd& crowd, uint32_t width, uint32_t height,
           const RendererOptions& options = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;

  // Records shadow map, terrain, crowd and sky after the crowd's tick in the same or an earlier submission.
  // The picture ends in image(), RGBA8 sRGB, ready to be copied from (TRANSFER_SRC). Throws Error(input)
  // where a herd has come that needs CrowdOptions::pose, which the crowd lacks. `over`, if any, draws on top
  // of it: it is called within dynamic rendering into one colour attachment of colourFormat and the picture's
  // size, without depth, one sample a pixel.
  void record(VkCommandBuffer commandBuffer, const View& view,
              const std::function<void(VkCommandBuffer)>& over = {});
  static constexpr VkFormat colourFormat = VK_FORMAT_R8G8B8A8_SRGB;
  VkImage image() const;
  uint32_t width() const;
  uint32_t height() const;
  // Images of the models that cannot be decoded, a line each: their materials are drawn in flat colours.
  const std::vector<std::string>& notes() const;

  // Whether pictures recorded from now on are timed pass by pass, where the device has timestamps: at first
  // they are not. Not free on software devices: each timestamp waits for what was drawn before it.
  void timeStages(bool on);
  std::vector<StageTime> stageTimes() const;  // of the last picture; waits for the device

  // Of the last picture, which has been submitted; waits for the device. Nothing before the first one.
  PictureCounts counts() const;

  // Waits for the device; tightly packed RGBA8 rows, top row first.
  std::vector<uint8_t> download() const;

 private:
  struct SKITTER_LOCAL Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skitter

#pragma once

#include "gpu/context.h"
#include "gpu/submit.h"

#include <cstdint>
#include <vector>

namespace skitter::gpu {

// The pictures of a window. A frame is
//   cmd = ring.begin();  record cmd;  show(cmd, ...);  ring.submit(links());  present();
// and where the window has no picture to give (minimised, just resized) the frame goes on without being
// shown.
class Swapchain {
 public:
  // Takes the surface over. Throws Error(device) when the device cannot present to it.
  Swapchain(const Context&, VkSurfaceKHR surface, uint32_t slots);
  // Waits for the device.
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  // The window's size in pixels, before each frame; nothing happens while it stays. Zero: there is nothing to
  // show.
  void resize(vk::Extent2D);

  // Records a copy of `picture`, scaled to the window, if the window has an image for it. `picture` is in
  // state transferSrc and stays so; `slot` is the ring's.
  void show(vk::CommandBuffer, vk::Image picture, vk::Extent2D extent, uint32_t slot);
  // What the submission of that command buffer waits for and signals.
  SubmitLinks links() const;
  // After the submission.
  void present();

 private:
  void create();
  void destroyImages();

  const Context& context_;
  vk::raii::SurfaceKHR surface_ = nullptr;
  vk::SurfaceFormatKHR format_;
  vk::Extent2D wanted_, extent_;
  bool stale_ = false;  // the window system asked for a new swapchain
  vk::raii::SwapchainKHR swapchain_ = nullptr;
  std::vector<vk::Image> images_;
  std::vector<vk::raii::Semaphore>
      acquired_;  // one a slot: its last wait is over when the slot comes round again
  std::vector<vk::raii::Semaphore> shown_;  // one an image: presentation tells nobody when it has waited
  bool showing_ = false;
  uint32_t slot_ = 0, image_ = 0;
};

}  // namespace skitter::gpu

// An SDL window that shows pictures of the host's.
#pragma once

#include <SDL.h>

#include <optional>
#include <vector>

#include "gpu.h"

namespace host {

class Window {
 public:
  Window(VkExtent2D extent);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  std::vector<const char*> instanceExtensions() const;
  // The surface goes with the instance, so before the Gpu: closeSurface().
  void open(Gpu& gpu);
  void close();

  // False once the user has closed the window.
  bool pump();
  // Where the mouse was pressed since the last call, in pixels.
  std::optional<VkOffset2D> takePress();

  // Records a copy of the picture, which is in TRANSFER_SRC_OPTIMAL, into the window's next image.
  void recordCopy(VkCommandBuffer cmd, const Image& picture, uint32_t slot);
  VkSemaphore acquired(uint32_t slot) const { return acquired_[slot]; }  // waited for by the copy
  VkSemaphore drawn() const { return drawn_[image_]; }                   // waited for by show()
  void show(const Queue& queue);

 private:
  SDL_Window* window_ = nullptr;
  Gpu* gpu_ = nullptr;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  VkExtent2D extent_;
  std::vector<VkImage> images_;
  std::vector<VkSemaphore> acquired_, drawn_;
  uint32_t image_ = 0;
  bool open_ = true;
  std::optional<VkOffset2D> press_;
};

}  // namespace host

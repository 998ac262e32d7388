#include "window.h"

#include <SDL_vulkan.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "drawing.h"

namespace host {
namespace {

void require(bool holds) {
  if (!holds) throw std::runtime_error(std::string("SDL: ") + SDL_GetError());
}

}  // namespace

Window::Window(VkExtent2D extent) : extent_(extent) {
  require(SDL_Init(SDL_INIT_VIDEO) == 0);
  window_ =
      SDL_CreateWindow("Skitter in a host", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED,
                       static_cast<int>(extent.width), static_cast<int>(extent.height), SDL_WINDOW_VULKAN);
  require(window_ != nullptr);
}

Window::~Window() {
  SDL_DestroyWindow(window_);
  SDL_Quit();
}

std::vector<const char*> Window::instanceExtensions() const {
  unsigned count = 0;
  require(SDL_Vulkan_GetInstanceExtensions(window_, &count, nullptr));
  std::vector<const char*> extensions(count);
  require(SDL_Vulkan_GetInstanceExtensions(window_, &count, extensions.data()));
  return extensions;
}

void Window::open(Gpu& gpu) {
  gpu_ = &gpu;
  require(SDL_Vulkan_CreateSurface(window_, gpu.instance, &surface_));
  VkBool32 supported = VK_FALSE;
  VK_CHECK(vkGetPhysicalDeviceSurfaceSupportKHR(gpu.physical, gpu.graphics.family, surface_, &supported));
  if (!supported) throw std::runtime_error("the graphics queue cannot present to the window");
  VkSurfaceCapabilitiesKHR can;
  VK_CHECK(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(gpu.physical, surface_, &can));
  uint32_t count = 1;
  VkSurfaceFormatKHR format;
  VK_CHECK(vkGetPhysicalDeviceSurfaceFormatsKHR(gpu.physical, surface_, &count, &format));
  VkSwapchainCreateInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
  info.surface = surface_;
  info.minImageCount =
      can.maxImageCount > 0 ? std::min(can.minImageCount + 1, can.maxImageCount) : can.minImageCount + 1;
  info.imageFormat = format.format;
  info.imageColorSpace = format.colorSpace;
  info.imageExtent = can.currentExtent.width == UINT32_MAX ? extent_ : can.currentExtent;
  info.imageArrayLayers = 1;
  info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  info.preTransform = can.currentTransform;
  info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
  info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
  VK_CHECK(vkCreateSwapchainKHR(gpu.device, &info, nullptr, &swapchain_));
  extent_ = info.imageExtent;
  VK_CHECK(vkGetSwapchainImagesKHR(gpu.device, swapchain_, &count, nullptr));
  images_.resize(count);
  VK_CHECK(vkGetSwapchainImagesKHR(gpu.device, swapchain_, &count, images_.data()));
  for (uint32_t i = 0; i < framesInFlight; ++i) acquired_.push_back(gpu.makeSemaphore());
  for (uint32_t i = 0; i < count; ++i) drawn_.push_back(gpu.makeSemaphore());
}

void Window::close() {
  if (gpu_ == nullptr) return;
  vkDeviceWaitIdle(gpu_->device);
  vkDestroySwapchainKHR(gpu_->device, swapchain_, nullptr);
  vkDestroySurfaceKHR(gpu_->instance, surface_, nullptr);
  gpu_ = nullptr;
}

bool Window::pump() {
  for (SDL_Event event; SDL_PollEvent(&event);) {
    if (event.type == SDL_QUIT) open_ = false;
    if (event.type == SDL_KEYDOWN && event.key.keysym.sym == SDLK_ESCAPE) open_ = false;
    if (event.type == SDL_MOUSEBUTTONDOWN) press_ = VkOffset2D{event.button.x, event.button.y};
  }
  return open_;
}

std::optional<VkOffset2D> Window::takePress() { return std::exchange(press_, std::nullopt); }

void Window::recordCopy(VkCommandBuffer cmd, const Image& picture, uint32_t slot) {
  VK_CHECK(
      vkAcquireNextImageKHR(gpu_->device, swapchain_, UINT64_MAX, acquired_[slot], VK_NULL_HANDLE, &image_));
  const VkImage image = images_[image_];
  transition(cmd, image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
             VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, 0,
             VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
  // A blit, because the window's format may be another.
  const auto corner = [](const VkExtent2D& extent) {
    return VkOffset3D{static_cast<int32_t>(extent.width), static_cast<int32_t>(extent.height), 1};
  };
  VkImageBlit region{};
  region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.srcOffsets[1] = corner(picture.extent);
  region.dstOffsets[1] = corner(extent_);
  vkCmdBlitImage(cmd, picture.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image,
                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_NEAREST);
  transition(cmd, image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
             VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
             VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_NONE, 0);
}

void Window::show(const Queue& queue) {
  VkPresentInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
  info.waitSemaphoreCount = 1;
  info.pWaitSemaphores = &drawn_[image_];
  info.swapchainCount = 1;
  info.pSwapchains = &swapchain_;
  info.pImageIndices = &image_;
  VK_CHECK(vkQueuePresentKHR(queue.queue, &info));
}

}  // namespace host

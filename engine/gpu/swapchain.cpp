#include "gpu/swapchain.h"

#include "gpu/barrier.h"

#include <algorithm>
#include <array>

namespace skitter::gpu {
namespace {

// The picture is sRGB, and a blit between sRGB images keeps its colours.
vk::SurfaceFormatKHR chooseFormat(const std::vector<vk::SurfaceFormatKHR>& offered) {
  for (const vk::Format format : {vk::Format::eB8G8R8A8Srgb, vk::Format::eR8G8B8A8Srgb}) {
    for (const vk::SurfaceFormatKHR& candidate : offered) {
      if (candidate.format == format && candidate.colorSpace == vk::ColorSpaceKHR::eSrgbNonlinear)
        return candidate;
    }
  }
  throw deviceError("the window offers no 8-bit sRGB pictures");
}

std::array<vk::Offset3D, 2> wholeOf(vk::Extent2D extent) {
  return {vk::Offset3D{}, vk::Offset3D{.x = int32_t(extent.width), .y = int32_t(extent.height), .z = 1}};
}

}  // namespace

Swapchain::Swapchain(const Context& context, VkSurfaceKHR surface, uint32_t slots)
    : context_(context), surface_(context.instance(), surface) {
  guarded("opening the window's surface", [&] {
    if (!context.physical().getSurfaceSupportKHR(context.queueFamily(), *surface_)) {
      throw deviceError(context.report().name + " cannot present to this window");
    }
    format_ = chooseFormat(context.physical().getSurfaceFormatsKHR(*surface_));
    for (uint32_t slot = 0; slot < slots; ++slot)
      acquired_.emplace_back(context.device(), vk::SemaphoreCreateInfo{});
  });
}

Swapchain::~Swapchain() {
  try {
    context_.waitIdle();
  } catch (const Error&) {
  }
}

void Swapchain::resize(vk::Extent2D extent) {
  if (extent == wanted_ && !stale_) return;
  wanted_ = extent;
  stale_ = false;
  context_.waitIdle();
  destroyImages();
  if (extent.width > 0 && extent.height > 0) guarded("making the window's pictures", [&] { create(); });
}

void Swapchain::create() {
  const vk::SurfaceCapabilitiesKHR can = context_.physical().getSurfaceCapabilitiesKHR(*surface_);
  if (!(can.supportedUsageFlags & vk::ImageUsageFlagBits::eTransferDst)) {
    throw deviceError("the window's pictures cannot be copied to");
  }
  // A surface either dictates its extent or leaves it to us (the special value).
  extent_ = can.currentExtent;
  if (extent_.width == UINT32_MAX) {
    extent_.width = std::clamp(wanted_.width, can.minImageExtent.width, can.maxImageExtent.width);
    extent_.height = std::clamp(wanted_.height, can.minImageExtent.height, can.maxImageExtent.height);
  }
  if (extent_.width == 0 || extent_.height == 0) return;
  uint32_t count = can.minImageCount + 1;
  if (can.maxImageCount > 0) count = std::min(count, can.maxImageCount);
  swapchain_ = vk::raii::SwapchainKHR(
      context_.device(), vk::SwapchainCreateInfoKHR{.surface = *surface_,
                                                    .minImageCount = count,
                                                    .imageFormat = format_.format,
                                                    .imageColorSpace = format_.colorSpace,
                                                    .imageExtent = extent_,
                                                    .imageArrayLayers = 1,
                                                    .imageUsage = vk::ImageUsageFlagBits::eTransferDst,
                                                    .imageSharingMode = vk::SharingMode::eExclusive,
                                                    .preTransform = can.currentTransform,
                                                    .compositeAlpha = vk::CompositeAlphaFlagBitsKHR::eOpaque,
                                                    .presentMode = vk::PresentModeKHR::eFifo,
                                                    .clipped = VK_TRUE});
  for (const VkImage image : swapchain_.getImages()) {
    images_.push_back(image);
    shown_.emplace_back(context_.device(), vk::SemaphoreCreateInfo{});
  }
}

void Swapchain::destroyImages() {
  images_.clear();
  shown_.clear();
  swapchain_ = nullptr;
}

void Swapchain::show(vk::CommandBuffer cmd, vk::Image picture, vk::Extent2D extent, uint32_t slot) {
  showing_ = false;
  if (!*swapchain_) return;
  slot_ = slot;
  try {
    const auto [result, image] = swapchain_.acquireNextImage(UINT64_MAX, *acquired_[slot]);
    if (result == vk::Result::eSuboptimalKHR) stale_ = true;
    image_ = image;
  } catch (const vk::OutOfDateKHRError&) {
    stale_ = true;
    return;
  } catch (const vk::SystemError& failure) {
    throw deviceError(std::string("waiting for the window: ") + failure.what());
  }
  showing_ = true;

  const vk::ImageSubresourceLayers colour{.aspectMask = vk::ImageAspectFlagBits::eColor, .layerCount = 1};
  const vk::ImageBlit2 blit{.srcSubresource = colour,
                            .srcOffsets = wholeOf(extent),
                            .dstSubresource = colour,
                            .dstOffsets = wholeOf(extent_)};
  transition(cmd, images_[image_], vk::ImageAspectFlagBits::eColor, ImageState::discard,
             ImageState::transferDst);
  cmd.blitImage2(vk::BlitImageInfo2{.srcImage = picture,
                                    .srcImageLayout = layoutOf(ImageState::transferSrc),
                                    .dstImage = images_[image_],
                                    .dstImageLayout = layoutOf(ImageState::transferDst),
                                    .regionCount = 1,
                                    .pRegions = &blit,
                                    .filter = vk::Filter::eLinear});
  transition(cmd, images_[image_], vk::ImageAspectFlagBits::eColor, ImageState::transferDst,
             ImageState::present);
}

SubmitLinks Swapchain::links() const {
  if (!showing_) return {};
  // All commands: the barrier that discards the image's old contents waits for every earlier stage.
  return {.wait = *acquired_[slot_],
          .waitStage = vk::PipelineStageFlagBits2::eAllCommands,
          .signal = *shown_[image_]};
}

void Swapchain::present() {
  if (!showing_) return;
  showing_ = false;
  try {
    const vk::Result result =
        context_.queue()->presentKHR(vk::PresentInfoKHR{.waitSemaphoreCount = 1,
                                                        .pWaitSemaphores = &*shown_[image_],
                                                        .swapchainCount = 1,
                                                        .pSwapchains = &*swapchain_,
                                                        .pImageIndices = &image_});
    if (result == vk::Result::eSuboptimalKHR) stale_ = true;
  } catch (const vk::OutOfDateKHRError&) {
    stale_ = true;
  } catch (const vk::SystemError& failure) {
    throw deviceError(std::string("showing a picture: ") + failure.what());
  }
}

}  // namespace skitter::gpu

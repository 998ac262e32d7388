#pragma once

#include "gpu/context.h"

#include <memory>
#include <string>

namespace skitter::gpu {

struct ImageInfo {
  vk::Format format = vk::Format::eUndefined;
  vk::Extent2D extent = {};
  vk::ImageUsageFlags usage =
      {};               // TRANSFER_SRC and TRANSFER_DST are added where the format allows, but for MSAA
  uint32_t layers = 1;  // more than one makes the view an array
  vk::SampleCountFlagBits samples = vk::SampleCountFlagBits::e1;
  uint32_t levels = 1;  // each half as wide and high as the one before, rounded down, at least 1
  bool codes = false;   // of R8G8B8A8 sRGB: whether Image::codes() is there
};

// A device-local 2D image and a view of all of it: heights, colour, depth, shadow, textures. It does
// not track its layout; barrier.h moves it from state to state.
class Image {
 public:
  Image() = default;
  // Throws Error(device) when the format, the extent or the memory is not to be had.
  Image(const Context&, const ImageInfo&, std::string name);

  const ImageInfo& info() const { return info_; }
  vk::Extent2D extent() const { return info_.extent; }
  vk::Format format() const { return info_.format; }
  vk::ImageAspectFlags aspect() const { return aspect_; }
  const std::string& name() const { return name_; }
  vk::Image handle() const { return handle_; }
  vk::ImageView view() const { return *view_; }
  explicit operator bool() const { return !!*image_; }

  // The same image, whose sRGB codes are read and written as plain numbers. It belongs to this one.
  const Image& codes() const { return *codes_; }

 private:
  void makeView(const Context&);

  ImageInfo info_;
  vk::ImageAspectFlags aspect_;
  std::string name_;
  vk::raii::DeviceMemory memory_ = nullptr;
  vk::raii::Image image_ = nullptr;
  vk::Image handle_;
  vk::raii::ImageView view_ = nullptr;
  std::unique_ptr<Image> codes_;
};

}  // namespace skitter::gpu

#include "gpu/image.h"

#include <fmt/format.h>

#include <array>

namespace skitter::gpu {
namespace {

constexpr vk::Format kCodes = vk::Format::eR8G8B8A8Unorm;

vk::ImageAspectFlags aspectOf(vk::Format format) {
  switch (format) {
    case vk::Format::eD16Unorm:
    case vk::Format::eX8D24UnormPack32:
    case vk::Format::eD32Sfloat:
      return vk::ImageAspectFlagBits::eDepth;
    default:
      return vk::ImageAspectFlagBits::eColor;
  }
}

vk::ImageUsageFlags withTransfer(const Context& context, const ImageInfo& info) {
  vk::ImageUsageFlags usage = info.usage;
  if (info.samples != vk::SampleCountFlagBits::e1) return usage;
  const auto features = context.physical().getFormatProperties(info.format).optimalTilingFeatures;
  if (features & vk::FormatFeatureFlagBits::eTransferSrc) usage |= vk::ImageUsageFlagBits::eTransferSrc;
  if (features & vk::FormatFeatureFlagBits::eTransferDst) usage |= vk::ImageUsageFlagBits::eTransferDst;
  return usage;
}

vk::ImageCreateFlags flagsOf(const ImageInfo& info) {
  return info.codes ? vk::ImageCreateFlagBits::eMutableFormat : vk::ImageCreateFlags();
}

void checkSupport(const Context& context, const ImageInfo& info, const std::string& name) {
  const auto refuse = [&](const std::string& reason) {
    return deviceError(fmt::format("the image \"{}\" ({} x {}, {} layers, {}, {} samples): {}", name,
                                   info.extent.width, info.extent.height, info.layers,
                                   vk::to_string(info.format), vk::to_string(info.samples), reason));
  };
  vk::ImageFormatProperties most;
  try {
    most = context.physical().getImageFormatProperties(info.format, vk::ImageType::e2D,
                                                       vk::ImageTiling::eOptimal, info.usage, flagsOf(info));
  } catch (const vk::FormatNotSupportedError&) {
    throw refuse(
        fmt::format("{} does not have this format for {}", context.report().name, vk::to_string(info.usage)));
  } catch (const vk::SystemError& failure) {
    throw refuse(failure.what());
  }
  if (info.extent.width == 0 || info.extent.height == 0) throw refuse("it is empty");
  if (info.extent.width > most.maxExtent.width || info.extent.height > most.maxExtent.height ||
      info.layers > most.maxArrayLayers) {
    throw refuse(fmt::format("{} allows {} x {}, {} layers", context.report().name, most.maxExtent.width,
                             most.maxExtent.height, most.maxArrayLayers));
  }
  if (!(most.sampleCounts & info.samples))
    throw refuse(fmt::format("{} has only {} samples for it", context.report().name,
                             vk::to_string(most.sampleCounts)));
}

}  // namespace

Image::Image(const Context& context, const ImageInfo& info, std::string name)
    : info_(info), aspect_(aspectOf(info.format)), name_(std::move(name)) {
  info_.usage = withTransfer(context, info);
  checkSupport(context, info_, name_);
  guarded("the image \"" + name_ + "\"", [&] {
    const std::array formats{info_.format, kCodes};
    const vk::ImageFormatListCreateInfo list{.viewFormatCount = uint32_t(formats.size()),
                                             .pViewFormats = formats.data()};
    image_ = vk::raii::Image(context.device(),
                             vk::ImageCreateInfo{.pNext = info_.codes ? &list : nullptr,
                                                 .flags = flagsOf(info_),
                                                 .imageType = vk::ImageType::e2D,
                                                 .format = info_.format,
                                                 .extent = {info_.extent.width, info_.extent.height, 1},
                                                 .mipLevels = info_.levels,
                                                 .arrayLayers = info_.layers,
                                                 .samples = info_.samples,
                                                 .tiling = vk::ImageTiling::eOptimal,
                                                 .usage = info_.usage});
    handle_ = *image_;
    context.name(*image_, name_);
    memory_ =
        context.allocate(image_.getMemoryRequirements(), vk::MemoryPropertyFlagBits::eDeviceLocal, {}, name_);
    context.name(*memory_, name_);
    image_.bindMemory(*memory_, 0);
    makeView(context);
    if (!info_.codes) return;
    codes_ = std::make_unique<Image>();
    codes_->info_ = info_;
    codes_->info_.format = kCodes;
    codes_->aspect_ = aspect_;
    codes_->name_ = name_ + ", codes";
    codes_->handle_ = handle_;
    codes_->makeView(context);
  });
}

void Image::makeView(const Context& context) {
  // An image that is only copied to and from takes no view.
  using Usage = vk::ImageUsageFlagBits;
  if (!(info_.usage &
        (Usage::eSampled | Usage::eStorage | Usage::eColorAttachment | Usage::eDepthStencilAttachment)))
    return;
  view_ = vk::raii::ImageView(
      context.device(),
      vk::ImageViewCreateInfo{
          .image = handle_,
          .viewType = info_.layers > 1 ? vk::ImageViewType::e2DArray : vk::ImageViewType::e2D,
          .format = info_.format,
          .subresourceRange = {aspect_, 0, info_.levels, 0, info_.layers}});
  context.name(*view_, name_);
}

}  // namespace skitter::gpu

#include "embedded/heights_comp_storage.h"
#include "embedded/heights_comp_texel.h"
#include "gpu/kernel.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "skitter/error.h"
#include "support/gpu_fixture.h"

#include <gmock/gmock.h>

namespace skitter::gpu {
namespace {

class ImageTest : public test::GpuTest {};

std::vector<float> ramp(size_t count) {
  std::vector<float> data(count);
  for (size_t i = 0; i < count; ++i) data[i] = 0.1f * float(i) - 3;
  return data;
}

TEST_F(ImageTest, RoundTripsInChunksOfRows) {
  const Image image(
      context(),
      {.format = vk::Format::eR32Sfloat, .extent = {33, 17}, .usage = vk::ImageUsageFlagBits::eSampled},
      "heights");
  const auto data = ramp(33 * 17);
  for (const uint64_t chunk : {uint64_t(1), uint64_t(33 * 4), uint64_t(1000), kStagingChunk}) {
    uploadImage(context(), image, data, ImageState::sampled, chunk);
    EXPECT_EQ(downloadImage<float>(context(), image, ImageState::sampled, chunk), data);
  }
}

TEST_F(ImageTest, OneWithoutPixelsIsRefused) {
  for (const vk::Extent2D extent : {vk::Extent2D{0, 4}, vk::Extent2D{4, 0}, vk::Extent2D{0, 0}}) {
    try {
      const Image image(
          context(),
          {.format = vk::Format::eR32Sfloat, .extent = extent, .usage = vk::ImageUsageFlagBits::eSampled},
          "nothing");
      ADD_FAILURE() << extent.width << " x " << extent.height;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("it is empty"));
    }
  }
}

TEST_F(ImageTest, KernelFetchesHeights) {
  const Image image(
      context(),
      {.format = vk::Format::eR32Sfloat, .extent = {21, 9}, .usage = vk::ImageUsageFlagBits::eSampled},
      "heights");
  const auto data = ramp(21 * 9);
  uploadImage(context(), image, data);
  const Buffer target(context(), data.size() * 16, "fetched");
  const Kernel kernel(context(), {.name = "heights",
                                  .code = {embedded::heights_comp_texel(), embedded::heights_comp_storage()},
                                  .bindings = {{0, BindingKind::heights}, {1, BindingKind::store}}});
  const Bindings bindings = kernel.bind(context(), {{0, &image}, {1, &target}});
  submitAndWait(context(), [&](vk::CommandBuffer cmd) { kernel.dispatch(cmd, bindings, {}, 1); });
  const auto fetched = download<std::array<float, 4>>(context(), target);
  for (size_t i = 0; i < data.size(); ++i) {
    EXPECT_EQ(fetched[i], (std::array{data[i], float(i % 21), float(i / 21), 1.f}));
  }
}

TEST_F(ImageTest, DepthAndColourClearsComeBack) {
  const Image colour(context(),
                     {.format = vk::Format::eR8G8B8A8Unorm,
                      .extent = {5, 3},
                      .usage = vk::ImageUsageFlagBits::eColorAttachment},
                     "colour");
  const Image depth(
      context(),
      {.format = vk::Format::eD32Sfloat,
       .extent = {5, 3},
       .usage = vk::ImageUsageFlagBits::eDepthStencilAttachment | vk::ImageUsageFlagBits::eSampled},
      "depth");
  submitAndWait(context(), [&](vk::CommandBuffer cmd) {
    transition(cmd, colour, ImageState::discard, ImageState::colour);
    transition(cmd, depth, ImageState::discard, ImageState::depth);
    const vk::RenderingAttachmentInfo colourInfo{
        .imageView = colour.view(),
        .imageLayout = layoutOf(ImageState::colour),
        .loadOp = vk::AttachmentLoadOp::eClear,
        .storeOp = vk::AttachmentStoreOp::eStore,
        .clearValue = {vk::ClearColorValue(std::array{1.f, 0.f, 1.f, 1.f})}};
    const vk::RenderingAttachmentInfo depthInfo{.imageView = depth.view(),
                                                .imageLayout = layoutOf(ImageState::depth),
                                                .loadOp = vk::AttachmentLoadOp::eClear,
                                                .storeOp = vk::AttachmentStoreOp::eStore,
                                                .clearValue = {vk::ClearDepthStencilValue{.depth = 0.25f}}};
    cmd.beginRendering(vk::RenderingInfo{.renderArea = {{0, 0}, {5, 3}},
                                         .layerCount = 1,
                                         .colorAttachmentCount = 1,
                                         .pColorAttachments = &colourInfo,
                                         .pDepthAttachment = &depthInfo});
    cmd.endRendering();
    transition(cmd, depth, ImageState::depth, ImageState::sampled);
  });
  EXPECT_THAT(downloadImage<uint32_t>(context(), colour, ImageState::colour), ::testing::Each(0xffff00ffu));
  EXPECT_THAT(downloadImage<float>(context(), depth, ImageState::sampled), ::testing::Each(0.25f));
}

TEST_F(ImageTest, ImpossibleImageSaysWhichAndWhy) {
  try {
    const Image image(context(),
                      {.format = vk::Format::eR32Sfloat,
                       .extent = {1u << 24, 1},
                       .usage = vk::ImageUsageFlagBits::eSampled},
                      "long terrain");
    FAIL() << "it was made";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::device);
    EXPECT_THAT(error.what(),
                ::testing::AllOf(::testing::HasSubstr("long terrain"), ::testing::HasSubstr("16777216")));
  }
}

}  // namespace
}  // namespace skitter::gpu

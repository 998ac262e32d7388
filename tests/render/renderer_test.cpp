#include <gmock/gmock.h>

#include "render/pictures.h"

namespace skitter::test {
namespace {

using ::testing::HasSubstr;

INSTANTIATE_TEST_SUITE_P(Loads, RendererTest, bothLoadPaths(), loadPathName);

TEST_P(RendererTest, drawsSkyAboveGroundWithoutAgents) {
  Stage stage(device(), smallScene(0), 160, 90);
  const Picture picture = stage.draw({.eye = {0, 6, -20}, .target = {0, 2, 0}});
  const glm::dvec3 sky = picture.mean(0, 8), ground = picture.mean(70, 89);
  EXPECT_GT(sky.b, sky.r);
  EXPECT_GT(ground.r, ground.b + 10);
  for (const double value : {sky.r, sky.b, ground.r}) {
    EXPECT_GT(value, 40);
    EXPECT_LT(value, 250);
  }
  double spread = 0;
  for (int x = 0; x < 160; ++x) spread += std::abs(picture.at(x, 80).r - ground.r);
  EXPECT_GT(spread / 160, 2);
  for (size_t i = 3; i < picture.rgba.size(); i += 4) ASSERT_EQ(picture.rgba[i], 255);
}

TEST_P(RendererTest, lightIsTheScenes) {
  const View view{.eye = {0, 6, -20}, .target = {0, 2, 0}};
  const auto drawn = [&](const Light& light) {
    Scene scene = smallScene(0);
    scene.light = light;
    return Stage(device(), scene, 160, 90).draw(view);
  };
  const auto lightness = [](const glm::dvec3& c) { return 0.21 * c.r + 0.72 * c.g + 0.07 * c.b; };
  const Picture day = drawn({}), overcast = drawn({.sky = Sky::overcast}),
                evening = drawn({.sky = Sky::evening}), night = drawn({.sky = Sky::night});
  const auto skyOf = [](const Picture& p) { return p.mean(0, 8); };
  const auto groundOf = [](const Picture& p) { return p.mean(70, 89); };
  // Grey clouds, a red evening, and a night that is dark and blue, but not black.
  EXPECT_LT(std::abs(skyOf(overcast).b - skyOf(overcast).r), 12);
  EXPECT_GT(skyOf(day).b, skyOf(day).r + 15);
  EXPECT_GT(skyOf(evening).r, skyOf(evening).b + 8);
  EXPECT_GT(skyOf(night).b, skyOf(night).r + 15);
  EXPECT_GT(groundOf(evening).r / groundOf(evening).b, 1.1 * groundOf(day).r / groundOf(day).b);
  EXPECT_LT(groundOf(overcast).r / groundOf(overcast).b, groundOf(day).r / groundOf(day).b);
  EXPECT_LT(lightness(skyOf(night)), 0.6 * lightness(skyOf(day)));
  EXPECT_LT(lightness(groundOf(night)), 0.6 * lightness(groundOf(day)));
  EXPECT_GT(lightness(groundOf(night)), 15);
  // Exposure and fog count where they are given.
  EXPECT_GT(lightness(groundOf(drawn({.exposure = 2}))), lightness(groundOf(day)) + 15);
  EXPECT_GT(differing(drawn({.fog = 20}), day), size_t{160 * 90 / 3});
}

TEST_P(RendererTest, theSamePictureTwiceAndAnotherWhenAgentsMove) {
  Stage stage(device(), smallScene(70), 200, 120);
  stage.tick(1);
  const View view = viewOf(stage.scene, stage.crowd, 0);
  const Picture first = stage.draw(view), again = stage.draw(view);
  EXPECT_EQ(differing(first, again), 0u);
  stage.tick(60);
  EXPECT_GT(differing(first, stage.draw(view)), 100u);
}

// Timed, crowd, ground and sky are drawn one rendering after the other instead of in one.
TEST_P(RendererTest, timingAPictureDoesNotChangeIt) {
  Stage stage(device(), smallScene(40), 200, 120);
  stage.tick(1);
  const View view = viewOf(stage.scene, stage.crowd, 0);
  const Picture plain = stage.draw(view);
  EXPECT_TRUE(stage.renderer.stageTimes().empty());
  stage.renderer.timeStages(true);
  EXPECT_EQ(differing(plain, stage.draw(view)), 0u);
  if (!context().timestamps()) return;
  std::vector<std::string> passes;
  for (const StageTime& time : stage.renderer.stageTimes()) {
    passes.push_back(time.stage);
    EXPECT_GE(time.milliseconds, 0) << time.stage;
  }
  passes.resize(6);  // edges are smoothed by a pass only where there are no samples to resolve
  EXPECT_THAT(passes, ::testing::ElementsAre("cull", "shadow", "splats", "crowd", "ground", "sky"));
}

// The colour of a picture of twice the size at one of its pixels: bilinear between the middles of pixels.
glm::dvec3 enlargedAt(const Picture& small, int x, int y) {
  const auto along = [](int at, uint32_t size) {
    const double place = std::clamp((at + 0.5) / 2 - 0.5, 0.0, double(size - 1));
    const int first = std::min(int(place), int(size) - 2);
    return std::pair(first, place - first);
  };
  const auto [left, right] = along(x, small.width);
  const auto [top, down] = along(y, small.height);
  const auto at = [&](int dx, int dy) { return glm::dvec3(small.at(left + dx, top + dy)); };
  return glm::mix(glm::mix(at(0, 0), at(1, 0), right), glm::mix(at(0, 1), at(1, 1), right), down);
}

TEST_P(RendererTest, fewerShadedPixelsAreTheSmallerPictureEnlarged) {
  for (const uint32_t agents : {0u, 40u}) {
    Stage stage(device(), smallScene(agents), 200, 120, {.scale = 0.5f});
    stage.tick(1);
    const View view = viewOf(stage.scene, stage.crowd, 0);
    const Picture large = stage.draw(view);
    Renderer half(device(), stage.crowd, 100, 60);
    gpu::submitAndWait(stage.context, [&](vk::CommandBuffer cmd) { half.record(cmd, view); });
    const Picture small{100, 60, half.download()};
    ASSERT_EQ(large.rgba.size(), 200u * 120 * 4);
    int off = 0;
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 200; ++x) {
        const glm::dvec3 by = glm::abs(glm::dvec3(large.at(x, y)) - enlargedAt(small, x, y));
        // Half a code of rounding, and another of a device that rounds each row first.
        off += std::max({by.r, by.g, by.b}) > 1;
      }
    // The shadow map has half the texels, too.
    EXPECT_LE(off, agents == 0 ? 0 : 200 * 120 / 10) << agents << " agents";
  }
}

TEST_P(RendererTest, timingAnEnlargedPictureDoesNotChangeIt) {
  Stage stage(device(), smallScene(40), 200, 120, {.scale = 0.5f});
  stage.tick(1);
  const View view = viewOf(stage.scene, stage.crowd, 0);
  const Picture large = stage.draw(view);
  stage.renderer.timeStages(true);
  EXPECT_EQ(differing(large, stage.draw(view)), 0u);
  if (!context().timestamps()) return;
  EXPECT_EQ(stage.renderer.stageTimes().back().stage, std::string("enlarge"));
}

TEST_P(RendererTest, whatIsDrawnOverKeepsThePictureAroundIt) {
  const auto red = [](VkCommandBuffer cmd) {
    const vk::ClearAttachment colour{.aspectMask = vk::ImageAspectFlagBits::eColor,
                                     .clearValue = {vk::ClearColorValue(std::array{1.0f, 0.0f, 0.0f, 1.0f})}};
    vk::CommandBuffer(cmd).clearAttachments(colour, vk::ClearRect{{{10, 20}, {30, 40}}, 0, 1});
  };
  for (const float scale : {1.0f, 0.5f}) {
    Stage stage(device(), smallScene(20), 200, 120, {.scale = scale});
    stage.tick(1);
    const View view = viewOf(stage.scene, stage.crowd, 0);
    const Picture without = stage.draw(view);
    gpu::submitAndWait(stage.context, [&](vk::CommandBuffer cmd) { stage.renderer.record(cmd, view, red); });
    const Picture with{200, 120, stage.renderer.download()};
    EXPECT_EQ(differing(without, with), 30u * 40u) << scale;
    EXPECT_EQ(with.at(10, 20), glm::ivec3(255, 0, 0));
    EXPECT_EQ(with.at(39, 59), glm::ivec3(255, 0, 0));
  }
}

TEST_P(RendererTest, anySizeIsDrawn) {
  const Scene scene = smallScene(3);
  for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 37u}, {333u, 2u}, {67u, 45u}})
    for (const float scale : {1.0f, 0.7f, 0.25f}) {
      Stage stage(device(), scene, width, height, {.scale = scale});
      stage.tick(1);
      EXPECT_EQ(stage.draw(viewOf(scene, stage.crowd, 0)).rgba.size(), size_t(width) * height * 4);
    }
}

TEST_P(RendererTest, strangeViewsAreDrawn) {
  Stage stage(device(), smallScene(5), 64, 48);
  stage.tick(1);
  for (const View& view :
       {View{.eye = {1, 2, 3}, .target = {1, 2, 3}}, View{.eye = {0, 30, 0}, .target = {0, 0, 0}},
        View{.eye = {0, -50, 0}, .target = {0, 0, 1}}, View{.eye = {0, 900, 0}, .target = {9, 0, 0}},
        View{.eye = {3900, 20, 3900}, .target = {0, 0, 0}}})
    EXPECT_NO_THROW(stage.draw(view));
}

TEST_P(RendererTest, impossibleSizesAreRefused) {
  const Scene scene = smallScene(0);
  const Heightfield terrain = scene.loadTerrain();
  const Crowd crowd(device(), terrain, scene);
  const auto faultOf = [&](uint32_t width, uint32_t height, Error::Kind kind) -> std::string {
    try {
      Renderer(device(), crowd, width, height);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind);
      return error.what();
    }
    return "no error";
  };
  const uint32_t most = device().report().limits.maxImageDimension2D;
  EXPECT_THAT(faultOf(0, 10, Error::Kind::input), HasSubstr("0 x 10"));
  EXPECT_THAT(faultOf(most + 1, 10, Error::Kind::device), HasSubstr(std::to_string(most)));
  EXPECT_THAT(faultOf(10, 4000000000u, Error::Kind::device), HasSubstr("4000000000"));
}

// Many records pages, so that agents of all of them are drawn.
TEST_P(RendererTest, pagingChangesNothing) {
  const Scene scene = smallScene(100);
  const Heightfield terrain = scene.loadTerrain();
  std::vector<Picture> pictures;
  for (const uint32_t pageAgents : {0u, 9u}) {
    CrowdOptions options;
    options.pageAgents = pageAgents;
    Crowd crowd(device(), terrain, scene, options);
    Renderer renderer(device(), crowd, 200, 120);
    gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
      crowd.record(cmd, 1.0f / 60);
      renderer.record(cmd, viewOf(scene, crowd, 0));
    });
    pictures.push_back({200, 120, renderer.download()});
  }
  EXPECT_EQ(differing(pictures[0], pictures[1]), 0u);
}

}  // namespace
}  // namespace skitter::test

// How shadows are looked up, held against docs/stages/pictures.md on a map of known texels.
#include <algorithm>
#include <random>
#include <vector>

#include "embedded/line_vert.h"
#include "embedded/sunlight_frag.h"
#include "gpu/graphics.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "render/bindings.h"
#include "render/picture.h"
#include "support/gpu_fixture.h"

namespace skitter::render {
namespace {

constexpr int kTexels = 32, kPoints = 400;
constexpr double kHalves[2] = {10, 45};       // metres, half a cascade's side
constexpr double kEye = -40, kFarDepth = 80;  // z, metres; the eye looks along +z

struct Line {
  glm::vec4 from, to, normal;
};

class SunlightTest : public test::GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    std::mt19937 random(3);
    for (float& depth : map_) depth = random() % 2 == 0 ? 0.25f : 0.75f;
  }

  // Cascades seen from straight above about the origin, in which every point lies at depth 0.5.
  std::vector<glm::vec2> drawn(const Line& line) {
    shared::Picture picture{};
    for (int i = 0; i < 2; ++i) {
      glm::mat4& clip = picture.clipFromPicture[shared::VIEW_CAMERA + 1 + i];
      clip = glm::mat4(0);
      clip[0][0] = clip[2][1] = float(1 / kHalves[i]);
      clip[3] = {0, 0, 0.5f, 1};
    }
    picture.eye = {0, 3, float(kEye), 0};
    picture.forward = {0, 0, 1, float(kFarDepth)};
    picture.shadow = {float(2 * kHalves[0] / kTexels), float(2 * kHalves[1] / kTexels), 0, kTexels};
    const gpu::Buffer block(context(), sizeof picture, "picture", gpu::BufferUse::uniform);
    gpu::upload(context(), block, std::span(&picture, 1));
    using Usage = vk::ImageUsageFlagBits;
    const gpu::Image shadow(
        context(),
        {.format = vk::Format::eD32Sfloat, .extent = {2 * kTexels, kTexels}, .usage = Usage::eSampled},
        "shadow map");
    gpu::uploadImage(context(), shadow, map_);
    const vk::raii::Sampler sampler = gpu::makeSampler(context(), {.name = "shadow comparison",
                                                                   .filter = vk::Filter::eNearest,
                                                                   .compare = vk::CompareOp::eLessOrEqual});
    using gpu::BindingKind;
    const gpu::GraphicsPipeline pipeline(context(),
                                         {.name = "sunlight",
                                          .vertex = embedded::line_vert(),
                                          .fragment = embedded::sunlight_frag(),
                                          .bindings = {{shared::DRAW_PICTURE, BindingKind::uniform},
                                                       {shared::DRAW_SHADOW, BindingKind::texture}},
                                          .pushBytes = sizeof(Line),
                                          .colour = vk::Format::eR32G32Sfloat,
                                          .depthUse = gpu::DepthUse::none});
    const std::vector<gpu::Binding> list{{shared::DRAW_PICTURE, &block},
                                         {shared::DRAW_SHADOW, &shadow, *sampler}};
    const gpu::Bindings bindings = pipeline.bind(context(), list);
    const gpu::Image image(
        context(),
        {.format = vk::Format::eR32G32Sfloat, .extent = {kPoints, 1}, .usage = Usage::eColorAttachment},
        "sunlight");
    gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
      gpu::transition(cmd, image, gpu::ImageState::discard, gpu::ImageState::colour);
      {
        const gpu::Rendering rendering(cmd, {.colour = &image}, true);
        pipeline.use(cmd, bindings, gpu::bytesOf(line));
        cmd.draw(3, 1, 0, 0);
      }
      gpu::transition(cmd, image, gpu::ImageState::colour, gpu::ImageState::transferSrc);
    });
    return gpu::downloadImage<glm::vec2>(context(), image, gpu::ImageState::transferSrc);
  }

  double lit(int column, int row) const {
    column = std::clamp(column, 0, 2 * kTexels - 1);
    row = std::clamp(row, 0, kTexels - 1);
    return map_[size_t(row * 2 * kTexels + column)] > 0.5f ? 1 : 0;
  }
  // The mean over a square of one texel about a point of the map.
  double square(const glm::dvec2& at) const {
    const glm::ivec2 first = glm::floor(at - 0.5);
    const glm::dvec2 f = at - 0.5 - glm::dvec2(first);
    return glm::mix(glm::mix(lit(first.x, first.y), lit(first.x + 1, first.y), f.x),
                    glm::mix(lit(first.x, first.y + 1), lit(first.x + 1, first.y + 1), f.x), f.y);
  }
  // The mean of two squares apart along the way over the map from one pixel to the next, in texels.
  double smooth(const glm::dvec2& at, const glm::dvec2& way) const {
    const double length = glm::length(way);
    const glm::dvec2 side = way / length, across(-side.y, side.x);
    const glm::dvec2 off = 3.0 / 16 * std::clamp(1.5 * length, 3.0, 32.0) * side + 0.3 * across;
    return 0.5 * (square(at - off) + square(at + off));
  }

  std::vector<float> map_ = std::vector<float>(size_t(2 * kTexels * kTexels));
};

TEST_F(SunlightTest, looksUpTheNearCascadeElseTheFarOneAndFadesWithDepth) {
  // A pixel of the last two covers several texels.
  for (const Line& line : {Line{{-43, 0, -31, 0}, {43, 0, 47, 0}, {0, 1, 0, 0}},
                           Line{{-1300, 0, 91, 0}, {1300, 0, -71, 0}, {0, 1, 0, 0}},
                           Line{{-9077.25f, 0, 50, 0}, {9122.75f, 0, -50, 0}, {0, 1, 0, 0}},
                           Line{{-12, 0, 12, 0}, {12, 0, -9, 0}, {0, 1, 0, 3}},
                           Line{{-30, 0, 46, 0}, {28, 0, -46, 0}, {0.6f, 0, 0.8f, 3}}}) {
    const std::vector<glm::vec2> found = drawn(line);
    // Metres: a point is a sum of two products of float32, and how far along it is comes interpolated.
    const double rounding = glm::length(glm::dvec3(line.to - line.from)) * 0x1p-22;
    int near = 0;
    for (int i = 0; i < kPoints; ++i) {
      const glm::dvec3 p = glm::mix(glm::dvec3(line.from), glm::dvec3(line.to), (i + 0.5) / kPoints);
      glm::dvec2 at[2];
      for (int k = 0; k < 2; ++k) {
        const glm::dvec3 off =
            p + glm::dvec3(line.normal) * double(line.normal.w) * (2 * kHalves[k] / kTexels);
        at[k] = glm::dvec2(off.x, off.z) / kHalves[k];
      }
      const int cascade = std::max(std::abs(at[0].x), std::abs(at[0].y)) < 0.98 ? 0 : 1;
      const double fade = std::clamp(((p.z - kEye) / kFarDepth - 0.8) / 0.18, 0.0, 1.0);
      const double share = fade * fade * (3 - 2 * fade);
      const glm::dvec2 texel = (at[cascade] + 1.0) * (0.5 * kTexels) + glm::dvec2(cascade * kTexels, 0);
      const glm::dvec3 way = glm::dvec3(line.to - line.from) / double(kPoints);
      const glm::dvec2 texels = glm::dvec2(way.x, way.z) * (0.5 * kTexels / kHalves[cascade]);
      const double expected = glm::mix(smooth(texel, texels), 1.0, share);
      const double once = glm::mix(square(texel), 1.0, share);
      // The far cascade's texels are those of the near one in another scale: the way is the same in metres.
      // Products of a float32 matrix and vector, and their difference between pixels: 1e-4 of a texel, over
      // which the light of a square changes by as much at most.
      const double tolerance = 2e-4 + rounding * 0.5 * kTexels / kHalves[cascade];
      EXPECT_NEAR(found[size_t(i)].x, expected, tolerance) << "point " << i << ", " << p.x << ", " << p.z;
      EXPECT_NEAR(found[size_t(i)].y, once, tolerance) << "point " << i << ", " << p.x << ", " << p.z;
      near += cascade == 0 ? 1 : 0;
    }
    EXPECT_GT(near, 0);
  }
}

}  // namespace
}  // namespace skitter::render

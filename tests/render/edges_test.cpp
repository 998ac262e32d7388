// The filter that smooths edges where there is one sample a pixel, held against docs/stages/pictures.md.
#include <algorithm>
#include <cmath>
#include <random>

#include "embedded/antialias_frag.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "render/image_pass.h"
#include "support/gpu_fixture.h"

namespace skitter::render {
namespace {

using Codes = std::vector<glm::u8vec4>;
constexpr int kColumns = 67, kRows = 43;

class EdgesTest : public test::GpuTest {
 protected:
  // Half a code is rounding to codes, which a GPU may miss by a tenth more (Direct3D 11.3, 3.2.3.6; Vulkan
  // allows either neighbour); float's own is less than a hundredth of one.
  double rounding() { return context().isCpu() ? 0.51 : 0.61; }

  // The filter's picture, in codes of squares, of one in codes of roots.
  Codes smoothed(const Codes& roots) {
    using Usage = vk::ImageUsageFlagBits;
    constexpr vk::Extent2D extent{kColumns, kRows};
    constexpr vk::Format format = vk::Format::eR8G8B8A8Unorm;
    const gpu::Image from(context(), {.format = format, .extent = extent, .usage = Usage::eSampled}, "roots");
    const gpu::Image to(context(), {.format = format, .extent = extent, .usage = Usage::eColorAttachment},
                        "smooth");
    gpu::uploadImage(context(), from, roots);
    const ImagePass pass(context(), "antialias", embedded::antialias_frag(), from, format);
    gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
      gpu::transition(cmd, to, gpu::ImageState::discard, gpu::ImageState::colour);
      {
        const gpu::Rendering rendering(cmd, {.colour = &to, .covered = true}, true);
        pass.draw(cmd);
      }
      gpu::transition(cmd, to, gpu::ImageState::colour, gpu::ImageState::transferSrc);
    });
    return gpu::downloadImage<glm::u8vec4>(context(), to, gpu::ImageState::transferSrc);
  }
};

double lumaOf(const glm::dvec3& c) { return 0.25 * c.r + 0.6 * c.g + 0.15 * c.b; }

struct Expected {
  glm::dvec3 square;
  bool decided;  // no rounding changes whether the pixel is smoothed
};

Expected expectedAt(const Codes& roots, int x, int y) {
  const auto at = [&](int column, int row) {
    column = std::clamp(column, 0, kColumns - 1);
    row = std::clamp(row, 0, kRows - 1);
    return glm::dvec3(roots[size_t(row * kColumns + column)]) / 255.0;
  };
  const glm::dvec3 c = at(x, y);
  glm::dvec3 mean(0);
  double least = lumaOf(c), most = least;
  for (const glm::ivec2 way : {glm::ivec2(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
    const glm::dvec3 beside = at(x + way.x, y + way.y);
    mean += 0.25 * beside;
    least = std::min(least, lumaOf(beside));
    most = std::max(most, lumaOf(beside));
  }
  const double contrast = most - least, threshold = std::max(0.05, 0.12 * most);
  const double k =
      contrast < threshold ? 0 : 0.6 * std::min(1.0, 2 * std::abs(lumaOf(mean) - lumaOf(c)) / contrast);
  const glm::dvec3 root = c + k * (mean - c);
  return {root * root, std::abs(contrast - threshold) > 1e-5};
}

void expectSmoothed(const Codes& roots, const Codes& found, double rounding) {
  int changed = 0;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      const size_t i = size_t(y * kColumns + x);
      const Expected expected = expectedAt(roots, x, y);
      if (!expected.decided) continue;
      for (int channel = 0; channel < 3; ++channel)
        ASSERT_NEAR(found[i][channel], 255 * expected.square[channel], rounding) << x << ", " << y;
      const glm::dvec3 own = glm::dvec3(roots[i]) / 255.0;
      changed += glm::distance(expected.square, own * own) > 0.02;
    }
  EXPECT_GT(changed, kColumns * kRows / 10);
}

TEST_F(EdgesTest, noiseOfAnyContrastIsSmoothedAsDocumented) {
  std::mt19937 random(5);
  Codes roots;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      const uint32_t step = uint32_t(5 * x + 3 * y) % 13, contrast = 1 + step * step;
      const auto channel = [&] { return uint8_t(std::min(255, 4 * y + int(random() % contrast))); };
      roots.push_back({channel(), channel(), channel(), 255});
    }
  expectSmoothed(roots, smoothed(roots), rounding());
}

// A line of one pixel that leans becomes softer, and nothing else.
TEST_F(EdgesTest, linesAreSoftenedAndPlainGroundIsKept) {
  const glm::u8vec4 ground(180, 160, 120, 255), line(40, 30, 25, 255);
  Codes roots(size_t(kColumns * kRows), ground);
  for (int x = 0; x < kColumns; ++x)
    for (const int y : {x / 5 + 12, kRows - 1 - x / 2}) roots[size_t(y * kColumns + x)] = line;
  const Codes found = smoothed(roots);
  expectSmoothed(roots, found, rounding());
  const auto squared = [](int code) { return code * code / 255.0; };
  EXPECT_NEAR(found[0].r, squared(ground.r), rounding());
  EXPECT_GT(found[size_t(16 * kColumns + 22)].r, squared(line.r) + 15);
}

}  // namespace
}  // namespace skitter::render

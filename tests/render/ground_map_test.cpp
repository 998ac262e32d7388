#include "render/ground_map.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "gpu/transfer.h"
#include "support/gpu_fixture.h"

namespace skitter::render {
namespace {

constexpr int kColumns = 41, kRows = 37;

class GroundMapTest : public test::GpuTest {
 protected:
  GroundMapTest() {
    field_.name = "made";
    field_.columns = kColumns;
    field_.rows = kRows;
    field_.spacingX = 0.5f;
    field_.spacingZ = 0.8f;
    field_.heights.assign(size_t(kColumns * kRows), 0.0f);
  }
  float& height(int x, int z) { return field_.heights[size_t(z * kColumns + x)]; }
  // Gradient, openness, sunlight.
  std::vector<glm::vec4> made(const glm::vec3& sun) {
    const gpu::Image map = makeGroundMap(context(), field_, glm::normalize(sun));
    std::vector<glm::vec4> texels;
    for (const uint64_t packed : gpu::downloadImage<uint64_t>(context(), map, gpu::ImageState::sampled))
      texels.push_back(glm::unpackHalf4x16(packed));
    return texels;
  }
  Heightfield field_;
};

constexpr size_t at(int x, int z) { return size_t(z * kColumns + x); }

// On a paraboloid, the difference over two samples is its gradient.
TEST_F(GroundMapTest, GradientsAreTheGrounds) {
  for (int z = 0; z < kRows; ++z)
    for (int x = 0; x < kColumns; ++x) {
      const float wx = 0.5f * float(x), wz = 0.8f * float(z);
      height(x, z) = 0.01f * wx * wx - 0.02f * wz * wz + 0.03f * wx * wz;
    }
  const std::vector<glm::vec4> map = made({0.1f, 1, 0.2f});
  for (int z = 1; z + 1 < kRows; ++z)
    for (int x = 1; x + 1 < kColumns; ++x) {
      const float wx = 0.5f * float(x), wz = 0.8f * float(z);
      // Half floats of at most 2.
      ASSERT_NEAR(map[at(x, z)].x, 0.02f * wx + 0.03f * wz, 2e-3f) << x << ", " << z;
      ASSERT_NEAR(map[at(x, z)].y, -0.04f * wz + 0.03f * wx, 2e-3f) << x << ", " << z;
    }
}

TEST_F(GroundMapTest, HollowsSeeLessOfTheSky) {
  height(12, 18) = -1;
  height(28, 18) = 1;
  const std::vector<glm::vec4> map = made({0, 1, 0});
  EXPECT_EQ(map[at(3, 3)].z, 1);
  EXPECT_LT(map[at(12, 18)].z, 0.75f);
  EXPECT_GT(map[at(28, 18)].z, 1.05f);
}

// A straight wall whose top rises along it throws a shadow that is a plane: what its top has at the place
// where the ray to the sun crosses it, less what the ray rises on the way.
TEST_F(GroundMapTest, AWallsShadowFallsAwayFromTheSun) {
  int half = 0;
  for (const glm::vec3& sun : {glm::vec3(0.8f, 0.5f, 0.2f),
                               {-0.8f, 0.5f, 0.3f},
                               {0.1f, 0.4f, 0.9f},
                               {-0.2f, 0.6f, -0.9f},
                               {0.7f, 0.3f, -0.4f}}) {
    const bool alongX = std::abs(sun.x) / 0.5f > std::abs(sun.z) / 0.8f;
    const int wall = 20;
    const auto top = [](float along) { return 3 + 0.1f * along; };  // samples along the wall
    std::ranges::fill(field_.heights, 0.0f);
    for (int i = 0; i < (alongX ? kRows : kColumns); ++i)
      (alongX ? height(wall, i) : height(i, wall)) = top(float(i));
    const std::vector<glm::vec4> map = made(sun);
    int shaded = 0;
    for (int n = 1; n < 16; ++n) {
      // Away from the sun.
      const float major = alongX ? sun.x / 0.5f : sun.z / 0.8f, minor = alongX ? sun.z / 0.8f : sun.x / 0.5f;
      const int line = wall - n * (major > 0 ? 1 : -1);
      const float drift = float(n) * minor / std::abs(major);
      for (int i = 14; i < 24; ++i) {
        const float along = float(i) + drift;
        if (along < 1 || along > 34) continue;
        const float shadow = top(along) - float(n) * sun.y / std::abs(major);
        const float lit = 1 - std::clamp(shadow / 0.35f, 0.0f, 1.0f);
        // Sixteen interpolations of a half float's 1e-3 at most.
        ASSERT_NEAR(map[alongX ? at(line, i) : at(i, line)].w, lit, 5e-3f)
            << "sun " << sun.x << " " << sun.z << ", " << n << " from the wall, " << i << " along it";
        shaded += lit == 0;
        half += lit > 0.1f && lit < 0.9f;
      }
    }
    EXPECT_GT(shaded, 5);
    // Towards the sun there is none.
    for (int i = 0; i < 30; ++i) {
      const int line = wall + 4 * ((alongX ? sun.x : sun.z) > 0 ? 1 : -1);
      EXPECT_EQ(map[alongX ? at(line, i) : at(i, line)].w, 1);
    }
  }
  EXPECT_GT(half, 10);
}

TEST_F(GroundMapTest, ASunStraightAboveThrowsNoShadow) {
  height(20, 18) = 5;
  for (const glm::vec4& texel : made({0, 1, 0})) EXPECT_EQ(texel.w, 1);
}

}  // namespace
}  // namespace skitter::render
